#pragma once

#include <algorithm>
#include <cmath>

#include "core/process/contract.h"

namespace imunoise {

/// The unbounded scale on which a parameter is searched and on which its estimate is close to
/// normal: the logarithm of a power or of a time, the logit between the bounds of anything else.
class ParameterScale {
 public:
  /// Parameter `index` of a process; number 0 is its power.
  ParameterScale(const ParameterInfo& info, std::size_t index)
      : lower_(info.lower), upper_(info.upper), logarithmic_(info.logarithmic || index == 0) {}

  bool logarithmic() const { return logarithmic_; }

  double to_scale(double value) const {
    if (logarithmic_) return std::log(value);
    const double gap = 1e-14 * (upper_ - lower_);
    return std::log(std::max(value - lower_, gap) / std::max(upper_ - value, gap));
  }
  double to_value(double at) const {
    if (logarithmic_) return std::exp(at);
    const double tail = (upper_ - lower_) / (1.0 + std::exp(std::abs(at)));
    return at < 0.0 ? lower_ + tail : upper_ - tail;
  }
  /// d value / d scale.
  double slope(double value) const {
    return logarithmic_ ? value : (value - lower_) * (upper_ - value) / (upper_ - lower_);
  }

 private:
  double lower_;
  double upper_;
  bool logarithmic_;
};

/// True where a search that keeps to the bounds of a parameter has run into one.
inline bool at_bound(const ParameterInfo& info, double value) {
  return value <= info.lower + 1e-9 * std::abs(info.lower) ||
         value >= info.upper - 1e-13 * std::abs(info.upper);
}

}  // namespace imunoise
