#pragma once

#include "core/process/contract.h"

namespace imunoise {

/// First-order autoregression x_t = φ x_{t-1} + e_t, var e = s². The wavelet variance holds 1e-10
/// relative for every φ in (-1, 1 - 1e-12] and every m up to 2^22.
struct Ar1 {
  double sigma2 = 1.0;  ///< s², of the innovations
  double phi = 0.5;

  static constexpr ProcessInfo kInfo{"AR1", "first-order Markov noise",
                                     "Noise with a memory: sensor bandwidth when the time is "
                                     "short, bias instability or temperature "
                                     "when it is long."};
  friend bool operator==(const Ar1&, const Ar1&) = default;

  std::vector<ParameterInfo> parameters() const;
  std::vector<double> values() const { return {sigma2, phi}; }
  void set_values(std::span<const double> v) {
    sigma2 = v[0];
    phi = v[1];
  }
  Eigen::ArrayXd shape(HalfWidths m) const;
  Eigen::ArrayXXd shape_jacobian(HalfWidths m) const;
  double spectrum(const Frequency& f) const;
  SumCovariance sum_covariance() const;
  std::vector<DerivedQuantity> derived(Hertz rate) const;
  std::vector<std::vector<double>> scan(const Scales& scales) const;

  struct Recursion {
    double phi;
    double innovation;  ///< its standard deviation
    double state;
    double next(RandomStream& rng) {
      const double now = state;
      state = phi * state + innovation * rng.normal();
      return now;
    }
  };
  Recursion recursion(RandomStream& rng) const;
};

/// Correlation times, in samples, spread over what `scales` can show: where to look for Markov
/// noise.
std::vector<double> scanned_correlation_times(const Scales& scales);

}  // namespace imunoise
