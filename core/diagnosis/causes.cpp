#include "core/diagnosis/causes.h"

#include <algorithm>
#include <cassert>

#include "core/diagnosis/missing_noise.h"
#include "core/effects/couplings/couplings.h"
#include "core/effects/known_effects.h"

namespace imunoise {
namespace {

std::vector<Cause> defects() {
  return {
      {"lost_samples",
       "lost samples",
       "The transfer dropped samples.",
       "the counter of the device with the samples",
       {},
       "integrity"},
      {"duplicated_samples",
       "duplicated samples",
       "The host read faster than the device renewed its registers.",
       "the device's counter or data-ready line",
       {},
       "integrity"},
      {"clock_jitter",
       "clock jitter",
       "Samples are not evenly spaced.",
       "the device's own time stamps",
       {},
       "integrity"},
      {"saturation",
       "saturation",
       "The signal left the range of the converter.",
       "the same with a wider range",
       {},
       "integrity"},
      {"dropouts",
       "placeholders",
       "A value that is none of the sensor's stands where a sample was missing.",
       "the device's status word, or the samples without placeholders",
       {},
       "integrity"},
      {"interpolated_samples",
       "interpolated samples",
       "The series was interpolated from another sampling rate, which weakens its noise.",
       "the raw samples",
       {},
       "integrity"},
      {"missing_codes",
       "missing codes",
       "The converter is not monotonic, or a digital gain behind it stretches its codes.",
       "the raw codes of the converter, before any gain",
       {},
       "integrity"},
      {"stuck",
       "stuck output",
       "The output repeats its value although the noise should change it.",
       "the device's status word",
       {},
       "integrity"},
  };
}

void append(std::vector<Cause>& to, const std::vector<Cause>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

}  // namespace

const std::vector<Cause>& known_causes() {
  static const std::vector<Cause> kAll = [] {
    std::vector<Cause> out = noise_causes();
    for (const Effect* effect : known_effects()) append(out, effect->causes);
    append(out, defects());
    return out;
  }();
  return kAll;
}

const Cause& cause_info(std::string_view id) {
  const std::vector<Cause>& all = known_causes();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Cause& one) { return one.id == id; });
  assert(found != all.end());
  return *found;
}

const Cause& cause_info(std::string_view id, const Witness* witness) {
  static const Cause kAnything{
      "cross_axis",
      "coupling to another channel",
      "That channel, or a quantity that changes with it, affects the output.",
      "the same while you change that channel on purpose",
      {},
      "cross_axis"};
  const bool unknown = witness != nullptr && measures_unknown(*witness);
  return unknown && id == kAnything.id ? kAnything : cause_info(id);
}

const Cause& defect_info(std::string_view id) {
  static const Cause kCodes{
      "quantisation",
      "few codes",
      "The noise is smaller than the step of the converter: rounding is then not white noise, and "
      "depends on where between two codes the mean lies.",
      "the same at a finer resolution or a smaller range",
      {},
      "quantisation"};
  return id == kCodes.id ? kCodes : cause_info(id);
}

}  // namespace imunoise
