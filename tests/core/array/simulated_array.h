#pragma once

// Realisations of an array's model, made from its definition: correlated innovations of each latent
// process by the square root of its power matrix.

#include <vector>

#include "core/array/latents.h"
#include "core/support/linear_algebra.h"
#include "core/wavelet/wavelet_covariance.h"

namespace imunoise::testing {

/// Samples of every sensor: one vector a sensor.
inline std::vector<std::vector<double>> simulated_array(const ArrayModel& model,
                                                        std::size_t samples, std::uint64_t seed,
                                                        std::uint32_t set) {
  std::vector<std::vector<double>> out(static_cast<std::size_t>(model.sensors),
                                       std::vector<double>(samples, 0.0));
  for (std::uint32_t t = 0; t < model.latents.size(); ++t) {
    const Latent& latent = model.latents[t];
    const Eigen::MatrixXd root = latent.matrix()
                                     ? square_root(latent.power)
                                     : Eigen::MatrixXd(latent.power.col(latent.sensors.front()) /
                                                       std::sqrt(latent.scalar()));
    for (Eigen::Index source = 0; source < root.cols(); ++source) {
      std::vector<double> unit(samples, 0.0);
      RandomStream random(seed, {set, t, static_cast<std::uint32_t>(source)});
      add_samples(latent.term.process, random, unit);
      for (Eigen::Index i = 0; i < model.sensors; ++i) {
        if (root(i, source) == 0.0) continue;
        for (std::size_t k = 0; k < samples; ++k) {
          out[static_cast<std::size_t>(i)][k] += root(i, source) * unit[k];
        }
      }
    }
  }
  return out;
}

inline WaveletCovariance simulated_moments(const ArrayModel& model, std::size_t samples,
                                           std::uint64_t seed, std::uint32_t set,
                                           int per_octave = 1) {
  const auto data = simulated_array(model, samples, seed, set);
  std::vector<Signal> signals;
  for (const auto& one : data) signals.emplace_back(std::span<const double>(one), Hertz{1.0});
  return wavelet_covariance(signals, Scales::for_samples(samples, per_octave));
}

}  // namespace imunoise::testing
