#include "core/model/common_names.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "core/effects/known_effects.h"
#include "core/effects/parse_full_model.h"

namespace imunoise {
namespace {

std::string refusal_of(const std::string& model) {
  const auto read = parse_full_model(model, Hertz{100.0}, {});
  return read ? "read" : read.error().message;
}

TEST(CommonNames, TermsOfDataSheetsLeadToTheProcess) {
  for (const auto& [written, meant] : std::vector<std::pair<std::string, std::string>>{
           {"ARW", "WN (angle random walk)"},
           {"vrw", "WN (velocity random walk)"},
           {"RRW", "RW (rate random walk)"},
           {"BI", "FN (bias instability)"},
           {"RR", "DR (rate ramp)"},
           {"GM1", "GM (first-order Gauss-Markov noise)"},
           {"sine", "line (a sine wave)"}}) {
    EXPECT_NE(refusal_of("WN + " + written).find("did you mean " + meant + "?"), std::string::npos)
        << refusal_of("WN + " + written);
  }
}

TEST(CommonNames, OtherwiseTheNearestProcessOrEffect) {
  EXPECT_NE(refusal_of("WN + outlier").find("did you mean outliers?"), std::string::npos);
  EXPECT_NE(refusal_of("WN + RES2").find("did you mean RES?"), std::string::npos);
  const std::string far = refusal_of("WN + zzzzzz");
  EXPECT_EQ(far.find("did you mean"), std::string::npos) << far;
  EXPECT_NE(far.find("processes: WN, QN"), std::string::npos) << far;
}

// What is suggested can be read, and what can be read is never "unknown".
TEST(CommonNames, EverySuggestionIsAModel) {
  for (const std::string name : {"ARW",   "N",      "AWGN", "white",        "RRW",          "K",
                                 "brown", "BI",     "B",    "flicker",      "pink",         "RR",
                                 "R",     "drift",  "Q",    "quantisation", "quantization", "GM1",
                                 "FOGM",  "Markov", "OU",   "AR",           "sin",          "tone",
                                 "RTN",   "RTS",    "trend"}) {
    const std::string why = refusal_of(name);
    const std::size_t at = why.find("did you mean ");
    ASSERT_NE(at, std::string::npos) << why;
    const std::string meant = why.substr(at + 13, why.find(' ', at + 13) - at - 13);
    const bool effect = effect_called(meant) != nullptr;
    EXPECT_TRUE(effect || refusal_of(meant) == "read") << name << ": " << meant;
  }
}

}  // namespace
}  // namespace imunoise
