#pragma once

#include <cmath>

#include "core/process/contract.h"

namespace imunoise {

/// White noise: independent samples of variance σ². ν(m) = σ²/2m.
struct WhiteNoise {
  double sigma2 = 1.0;

  static constexpr ProcessInfo kInfo{"WN", "white noise",
                                     "Thermal and electronic noise, the same at all frequencies: "
                                     "integrated, it becomes the angle or "
                                     "velocity random walk."};
  friend bool operator==(const WhiteNoise&, const WhiteNoise&) = default;

  std::vector<ParameterInfo> parameters() const { return {{"sigma2", "variance of each sample"}}; }
  std::vector<double> values() const { return {sigma2}; }
  void set_values(std::span<const double> v) { sigma2 = v[0]; }
  Eigen::ArrayXd shape(HalfWidths m) const { return 0.5 / m; }
  Eigen::ArrayXXd shape_jacobian(HalfWidths m) const { return no_shape_jacobian(m); }
  double spectrum(const Frequency&) const { return sigma2; }
  SumCovariance sum_covariance() const { return {.linear = -0.5 * sigma2}; }
  std::vector<DerivedQuantity> derived(Hertz rate) const {
    return {{Coefficient::kRandomWalk, std::sqrt(sigma2 / rate.value)}};
  }
  std::vector<std::vector<double>> scan(const Scales&) const { return {{}}; }

  struct Recursion {
    double sigma;
    double next(RandomStream& rng) const { return sigma * rng.normal(); }
  };
  Recursion recursion(RandomStream&) const { return {std::sqrt(sigma2)}; }
};

}  // namespace imunoise
