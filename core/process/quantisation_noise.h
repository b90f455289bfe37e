#pragma once

#include <cmath>
#include <numbers>
#include <utility>

#include "core/process/contract.h"

namespace imunoise {

/// Quantisation noise x_t = e_t - e_{t-1}, var e = Q². ν(m) = 6Q²/(2m)².
struct QuantisationNoise {
  double q2 = 1.0;

  static constexpr ProcessInfo kInfo{"QN", "quantisation noise",
                                     "Rounding of an accumulated angle or velocity: the error of "
                                     "one interval is given back in the next."};
  friend bool operator==(const QuantisationNoise&, const QuantisationNoise&) = default;

  std::vector<ParameterInfo> parameters() const {
    return {{"q2", "variance of the rounding error"}};
  }
  std::vector<double> values() const { return {q2}; }
  void set_values(std::span<const double> v) { q2 = v[0]; }
  Eigen::ArrayXd shape(HalfWidths m) const { return 1.5 / m.square(); }
  Eigen::ArrayXXd shape_jacobian(HalfWidths m) const { return no_shape_jacobian(m); }
  double spectrum(const Frequency& f) const {
    const double s = 2.0 * f.half_sine;
    return q2 * s * s;
  }
  SumCovariance sum_covariance() const { return {.near = {q2}}; }
  std::vector<DerivedQuantity> derived(Hertz rate) const {
    return {{Coefficient::kQuantisation, std::sqrt(q2) / rate.value}};
  }
  std::vector<std::vector<double>> scan(const Scales&) const { return {{}}; }

  struct Recursion {
    double sigma;
    double before;
    double next(RandomStream& rng) {
      const double now = sigma * rng.normal();
      return now - std::exchange(before, now);
    }
  };
  Recursion recursion(RandomStream& rng) const {
    const double sigma = std::sqrt(q2);
    return {sigma, sigma * rng.normal()};
  }
};

}  // namespace imunoise
