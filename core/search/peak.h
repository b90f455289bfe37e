#pragma once

#include <cmath>

namespace imunoise {

/// The top of a log-likelihood over one shape.
struct Peak {
  double at = 0.0;
  double gain = 0.0;
  double error = 0.0;  ///< standard error, from the curvature there; 0 where it is flat
};

/// The top of `gain` between two points that enclose one, by golden section. `step`: over which the
/// curvature is taken.
template <class Gain>
Peak peak_between(double low, double high, double step, const Gain& gain) {
  constexpr double kGolden = 0.6180339887498949;
  constexpr int kRounds = 16;
  double a = high - kGolden * (high - low);
  double b = low + kGolden * (high - low);
  double at_a = gain(a);
  double at_b = gain(b);
  for (int i = 0; i < kRounds; ++i) {
    if (at_a > at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - kGolden * (high - low);
      at_a = gain(a);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + kGolden * (high - low);
      at_b = gain(b);
    }
  }
  const double at = at_a > at_b ? a : b;
  const double top = gain(at);
  const double curvature = (2.0 * top - gain(at - step) - gain(at + step)) / (step * step);
  return {at, top, curvature > 0.0 ? 1.0 / std::sqrt(curvature) : 0.0};
}

}  // namespace imunoise
