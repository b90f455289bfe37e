#pragma once

// Arrays of sensors with correlated, coloured noise, and what goes wrong with them.

#include <cmath>
#include <vector>

#include "core/faults/fault_detector.h"
#include "tests/core/array/simulated_array.h"

namespace imunoise::testing {

using Readings = std::vector<std::vector<double>>;  // one vector a sensor

/// An array whose matrix powers correlate by `correlation`: text in the grammar, one power a term.
inline ArrayModel array_model(const char* text, Eigen::Index sensors,
                              const std::vector<double>& powers, double correlation = 0.0) {
  const Model written = parse_array_model(text, Hertz{1.0}).value();
  ArrayModel out = expand(written, {static_cast<std::size_t>(sensors), {}});
  for (Latent& latent : out.latents) {
    const double power = powers[latent.written];
    if (latent.matrix()) {
      latent.power.setConstant(correlation * power);
      latent.power.diagonal().setConstant(power);
    } else {
      latent.set_scalar(power);
    }
  }
  return out;
}

/// Three sensors: white noise, Markov noise of 30 samples that correlates, a correlated random walk
/// and a resonance that all of them see.
inline ArrayModel coloured_model() {
  return array_model("RW[corr] + AR1(phi=0.967)[corr] + WN + RES(r=0.97, omega=0.5)[all]", 3,
                     {1e-5, 0.01, 1.0, 0.05}, 0.6);
}

inline Eigen::VectorXd reading(const Readings& readings, std::size_t t) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(readings.size()));
  for (std::size_t i = 0; i < readings.size(); ++i) {
    out(static_cast<Eigen::Index>(i)) = readings[i][t];
  }
  return out;
}

/// All faults that a detector finds in a recording.
inline std::vector<Fault> faults_in(FaultDetector& detector, const Readings& readings) {
  std::vector<Fault> out;
  for (std::size_t t = 0; t < readings.front().size(); ++t) {
    if (auto fault = detector.feed(reading(readings, t))) out.push_back(std::move(*fault));
  }
  if (auto fault = detector.finish()) out.push_back(std::move(*fault));
  return out;
}

}  // namespace imunoise::testing
