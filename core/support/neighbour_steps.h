#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace imunoise {

/// How neighbouring values of a series differ.
struct NeighbourSteps {
  double smallest =
      std::numeric_limits<double>::infinity();  ///< but for none: the converter's step
  double mean_square = 0.0;

  /// Standard deviation of what changes from one value to the next, in steps of the converter, as
  /// if it were white; rounding adds 1/12 to its square. Infinite where there is no step.
  double noise_in_steps() const {
    if (!(smallest > 0.0) || !std::isfinite(smallest)) return INFINITY;
    const double ratio = mean_square / (smallest * smallest);
    return std::sqrt(std::max(0.0, 0.5 * ratio - 1.0 / 12.0));
  }
};

inline NeighbourSteps neighbour_steps(std::span<const double> series) {
  NeighbourSteps out;
  if (series.size() < 2) return out;
  for (std::size_t t = 1; t < series.size(); ++t) {
    const double step = std::abs(series[t] - series[t - 1]);
    if (step > 0.0) out.smallest = std::min(out.smallest, step);
    out.mean_square += step * step;
  }
  out.mean_square /= static_cast<double>(series.size() - 1);
  return out;
}

}  // namespace imunoise
