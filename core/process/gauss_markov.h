#pragma once

#include <cmath>

#include "core/process/ar1.h"

namespace imunoise {

/// The continuous-time form of Ar1: stationary variance σ² and correlation time T_c in seconds,
/// sampled at `rate`: φ = exp(-1/(T_c·rate)), s² = σ²(1 - φ²).
struct GaussMarkov {
  double sigma2 = 1.0;  ///< of the noise itself, not of its innovations
  double tc = 1.0;      ///< s
  Hertz rate;

  static constexpr ProcessInfo kInfo{"GM", "Gauss-Markov noise",
                                     "Noise with a memory, in continuous time: bias instability, "
                                     "temperature or sensor bandwidth."};
  friend bool operator==(const GaussMarkov&, const GaussMarkov&) = default;

  /// The same noise in discrete time.
  Ar1 discrete() const {
    const double decay = -1.0 / (tc * rate.value);
    return {-sigma2 * std::expm1(2.0 * decay), std::exp(decay)};
  }

  std::vector<ParameterInfo> parameters() const {
    return {{"sigma2", "variance of the noise"},
            {"tc", "correlation time", Dimension::kSeconds, 0.02 / rate.value, 1e12 / rate.value,
             true}};
  }
  std::vector<double> values() const { return {sigma2, tc}; }
  void set_values(std::span<const double> v) {
    sigma2 = v[0];
    tc = v[1];
  }
  Eigen::ArrayXd shape(HalfWidths m) const {
    return GaussMarkov{1.0, tc, rate}.discrete().sigma2 * discrete().shape(m);
  }
  Eigen::ArrayXXd shape_jacobian(HalfWidths m) const {
    const Ar1 unit = GaussMarkov{1.0, tc, rate}.discrete();
    const double phi_slope = unit.phi / (tc * tc * rate.value);
    return phi_slope * (unit.sigma2 * unit.shape_jacobian(m) - (2.0 * unit.phi * unit.shape(m)));
  }
  double spectrum(const Frequency& f) const { return discrete().spectrum(f); }
  SumCovariance sum_covariance() const { return discrete().sum_covariance(); }
  std::vector<DerivedQuantity> derived(Hertz) const {
    return {{Coefficient::kAmplitude, std::sqrt(sigma2)}, {Coefficient::kCorrelationTime, tc}};
  }
  std::vector<std::vector<double>> scan(const Scales& scales) const {
    std::vector<std::vector<double>> out;
    for (const double time : scanned_correlation_times(scales)) out.push_back({time / rate.value});
    return out;
  }
  Ar1::Recursion recursion(RandomStream& rng) const { return discrete().recursion(rng); }
};

}  // namespace imunoise
