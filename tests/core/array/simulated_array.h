#pragma once

// Moments and powers of realisations of an array's model.

#include <vector>

#include "core/array/simulate_array.h"
#include "core/spectrum/cross_power.h"
#include "core/wavelet/wavelet_covariance.h"

namespace imunoise::testing {

/// One realisation: one vector a sensor.
inline std::vector<std::vector<double>> simulated_array(const ArrayModel& model,
                                                        std::size_t samples, std::uint64_t seed,
                                                        std::uint32_t set) {
  const Eigen::MatrixXd columns = simulate(model, samples, seed, set);
  std::vector<std::vector<double>> out;
  for (const auto column : columns.colwise()) out.emplace_back(column.begin(), column.end());
  return out;
}

inline WaveletCovariance moments_of(const Eigen::MatrixXd& samples, int per_octave = 1) {
  return wavelet_covariance(
      signals_of(samples, Hertz{1.0}),
      Scales::for_samples(static_cast<std::size_t>(samples.rows()), per_octave));
}

inline CrossPower powers_of(const Eigen::MatrixXd& samples) {
  return cross_power(samples_of(signals_of(samples, Hertz{1.0})), Hertz{1.0});
}

inline WaveletCovariance simulated_moments(const ArrayModel& model, std::size_t samples,
                                           std::uint64_t seed, std::uint32_t set,
                                           int per_octave = 1) {
  return moments_of(simulate(model, samples, seed, set), per_octave);
}

}  // namespace imunoise::testing
