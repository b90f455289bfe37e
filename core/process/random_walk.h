#pragma once

#include <cmath>
#include <numbers>

#include "core/process/contract.h"

namespace imunoise {

/// Random walk with increments of variance γ². ν(m) = γ²(4m² + 2)/24m.
struct RandomWalk {
  double gamma2 = 1.0;

  static constexpr ProcessInfo kInfo{
      "RW", "random walk",
      "A bias that wanders without bound: slow ageing and everything slower than the recording."};
  friend bool operator==(const RandomWalk&, const RandomWalk&) = default;

  std::vector<ParameterInfo> parameters() const {
    return {{"gamma2", "variance of the increments"}};
  }
  std::vector<double> values() const { return {gamma2}; }
  void set_values(std::span<const double> v) { gamma2 = v[0]; }
  Eigen::ArrayXd shape(HalfWidths m) const { return (2.0 * m.square() + 1.0) / (12.0 * m); }
  Eigen::ArrayXXd shape_jacobian(HalfWidths m) const { return no_shape_jacobian(m); }
  double spectrum(const Frequency& f) const {
    const double s = 2.0 * f.half_sine;
    return gamma2 / (s * s);
  }
  SumCovariance sum_covariance() const {
    return {.linear = -gamma2 / 12.0, .cubic = gamma2 / 12.0};
  }
  std::vector<DerivedQuantity> derived(Hertz rate) const {
    return {{Coefficient::kRateRandomWalk, std::sqrt(gamma2 * rate.value)}};
  }
  std::vector<std::vector<double>> scan(const Scales&) const { return {{}}; }

  struct Recursion {
    double gamma;
    double level = 0.0;
    double next(RandomStream& rng) { return level += gamma * rng.normal(); }
  };
  Recursion recursion(RandomStream&) const { return {std::sqrt(gamma2)}; }
};

}  // namespace imunoise
