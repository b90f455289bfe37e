#pragma once

// A gyro on a rotation table, as Clausen et al. (2018) tabulate it: white noise of 0.146 °/√h at
// 30 °/s that grows to 0.439 °/√h at 390 °/s, quantisation noise of 9.8e-6 (rad/s)² that falls to
// nothing.

#include <cmath>
#include <string>
#include <vector>

#include "core/dynamic/dynamic_fit.h"

namespace imunoise::testing {

inline constexpr Hertz kTableRate{100};
inline constexpr const char* kTableModel = "QN(q2~exp) + WN(sigma2~exp)";
inline constexpr double kRandomWalkUnit = 3.14159265358979323846 / 180.0 / 60.0;  // 1 °/√h in SI

/// Rates at which the table turns, °/s.
inline std::vector<double> table_rates() { return {30, 90, 150, 210, 270, 330, 390}; }

/// Angle random walk in °/√h.
inline double table_random_walk(double rate) {
  return 0.146 * std::pow(0.439 / 0.146, (rate - 30.0) / 360.0);
}
/// Variance of the rounding error, (rad/s)²: a ten-thousandth is left at the end.
inline double table_rounding(double rate) { return 9.8e-6 * std::pow(1e-4, (rate - 30.0) / 360.0); }

inline Model table_truth(double rate) {
  Model out = parse_model("QN + WN", kTableRate).value();
  const double density = table_random_walk(rate) * kRandomWalkUnit;
  set_values(out.terms[0].process, std::vector{table_rounding(rate)});
  set_values(out.terms[1].process, std::vector{density * density * kTableRate.value});
  return out;
}

/// One dwell a rate, simulated.
inline std::vector<CovariateBin> simulated_table(std::size_t samples, std::uint64_t seed,
                                                 std::uint32_t set) {
  std::vector<CovariateBin> out;
  for (const double rate : table_rates()) {
    const auto stream = 100 * set + static_cast<std::uint32_t>(out.size());
    const std::vector<double> x = simulate(table_truth(rate), samples, seed, stream);
    out.push_back({rate,
                   {wavelet_variance(Signal(std::span<const double>(x), kTableRate),
                                     Scales::for_samples(samples))}});
  }
  return out;
}

}  // namespace imunoise::testing
