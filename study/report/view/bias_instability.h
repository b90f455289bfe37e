#pragma once

#include <string>
#include <vector>

#include "imunoise/v1/noise.pb.h"
#include "study/words/number.h"

namespace imunoise::report {

/// One of the quantities that are called bias instability, in words.
struct BiasInstability {
  std::string meaning;  ///< which of them
  std::string value;    ///< with its unit; "none" where there is none
  std::string remark;   ///< its averaging time, or why there is none
};

/// Those of a fit, in units of data sheets. Thread-safe.
std::vector<BiasInstability> bias_instabilities(const v1::FitReport& report, Digits digits);

}  // namespace imunoise::report
