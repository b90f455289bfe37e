#pragma once

#include <cmath>

#include "core/process/contract.h"

namespace imunoise {

/// Rate ramp: a deterministic ramp of slope ω per sample; ν(m) = ω²m²/4. Its sign cannot be seen.
struct RateRamp {
  double omega2 = 1.0;

  static constexpr ProcessInfo kInfo{
      "DR", "rate ramp",
      "A bias that moves steadily: slow temperature or ageing seen as a straight line."};
  friend bool operator==(const RateRamp&, const RateRamp&) = default;

  std::vector<ParameterInfo> parameters() const {
    return {{"omega2", "square of the slope per sample"}};
  }
  std::vector<double> values() const { return {omega2}; }
  void set_values(std::span<const double> v) { omega2 = v[0]; }
  Eigen::ArrayXd shape(HalfWidths m) const { return 0.25 * m.square(); }
  Eigen::ArrayXXd shape_jacobian(HalfWidths m) const { return no_shape_jacobian(m); }
  double spectrum(const Frequency&) const { return 0.0; }  // deterministic
  SumCovariance sum_covariance() const { return {.slope_squared = omega2}; }
  std::vector<DerivedQuantity> derived(Hertz rate) const {
    return {{Coefficient::kRamp, std::sqrt(omega2) * rate.value}};
  }
  std::vector<std::vector<double>> scan(const Scales&) const { return {{}}; }

  struct Recursion {
    double omega;
    double index = 0.0;
    double next(RandomStream&) { return omega * index++; }
  };
  Recursion recursion(RandomStream&) const { return {std::sqrt(omega2)}; }
};

}  // namespace imunoise
