#include "core/model/common_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "core/support/nearest_word.h"

namespace imunoise {
namespace {

struct CommonName {
  std::string_view name;  // in capital letters
  std::string_view ours;
  std::string_view means;
};

// Coefficients of IEEE Std 952 and 647, their abbreviations, and the words of other programs.
constexpr std::array kCommonNames{
    CommonName{"ARW", "WN", "angle random walk"},
    CommonName{"VRW", "WN", "velocity random walk"},
    CommonName{"N", "WN", "angle or velocity random walk"},
    CommonName{"AWGN", "WN", "white noise"},
    CommonName{"WHITE", "WN", "white noise"},
    CommonName{"RRW", "RW", "rate random walk"},
    CommonName{"K", "RW", "rate random walk"},
    CommonName{"BROWN", "RW", "random walk"},
    CommonName{"BROWNIAN", "RW", "random walk"},
    CommonName{"BI", "FN", "bias instability"},
    CommonName{"B", "FN", "bias instability"},
    CommonName{"FLICKER", "FN", "flicker noise"},
    CommonName{"PINK", "FN", "flicker noise"},
    CommonName{"RR", "DR", "rate ramp"},
    CommonName{"R", "DR", "rate ramp"},
    CommonName{"DRIFT", "DR", "rate ramp"},
    CommonName{"Q", "QN", "quantisation noise"},
    CommonName{"QUANTISATION", "QN", "quantisation noise"},
    CommonName{"QUANTIZATION", "QN", "quantisation noise"},
    CommonName{"GM1", "GM", "first-order Gauss-Markov noise"},
    CommonName{"FOGM", "GM", "first-order Gauss-Markov noise"},
    CommonName{"MARKOV", "GM", "first-order Gauss-Markov noise"},
    CommonName{"OU", "GM", "Ornstein-Uhlenbeck noise"},
    CommonName{"AR", "AR1", "first-order autoregression"},
    CommonName{"SIN", "line", "a sine wave"},
    CommonName{"SINE", "line", "a sine wave"},
    CommonName{"SINUSOID", "line", "a sine wave"},
    CommonName{"TONE", "line", "a sine wave"},
    CommonName{"RTN", "telegraph", "jumps between two levels"},
    CommonName{"RTS", "telegraph", "jumps between two levels"},
    CommonName{"TREND", "ramp", "a constant slope"},
    CommonName{"TEMPERATURE", "witness(temperature)", "the output follows the temperature"},
};

}  // namespace

std::string meant_by(std::string_view name, std::span<const std::string> known) {
  std::string capitals(name);
  std::transform(capitals.begin(), capitals.end(), capitals.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  const auto* const common =
      std::find_if(kCommonNames.begin(), kCommonNames.end(),
                   [&](const CommonName& one) { return one.name == capitals; });
  if (common != kCommonNames.end())
    return fmt::format("did you mean {} ({})?", common->ours, common->means);
  const std::string_view near = nearest_word(name, known);
  return near.empty() ? "" : fmt::format("did you mean {}?", near);
}

}  // namespace imunoise
