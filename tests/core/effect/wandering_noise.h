#pragma once

// White noise whose power wanders, for tests.

#include <cmath>

#include "core/regression/modulation.h"
#include "core/support/random.h"

namespace imunoise {

/// Two replicates of so many samples; the logarithm of their power is a Markov process of this
/// correlation time (samples) and standard deviation.
inline Innovations wandering_noise(double tau, double deviation, std::uint64_t seed,
                                   Eigen::Index samples) {
  RandomStream random(seed);
  const double phi = std::exp(-1.0 / tau);
  Innovations out;
  for (std::size_t k = 0; k < 2; ++k) {
    Eigen::VectorXd y(samples);
    double course = random.normal();
    for (double& x : y) {
      x = random.normal() * std::exp(0.5 * deviation * course);
      course = phi * course + std::sqrt(1.0 - phi * phi) * random.normal();
    }
    out.replicates.push_back(k);
    out.white.push_back(std::move(y));
  }
  return out;
}

}  // namespace imunoise
