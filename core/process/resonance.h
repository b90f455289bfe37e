#pragma once

#include <cmath>

#include "core/process/contract.h"
#include "core/process/second_order_recursion.h"

namespace imunoise {

/// A damped oscillation driven by white noise: x_t = 2r cos ω x_{t-1} - r² x_{t-2} + e_t, var e =
/// s². Autocovariance γ(h) = Re(C z^h), z = re^{iω}, C = s²[(1+r²)/(1-r²) - i cot ω] / [(1-r²)² +
/// 4r² sin² ω].
struct Resonance {
  double sigma2 = 1.0;  ///< s², of the driving noise
  double r = 0.9;       ///< decay per sample, 0 < r < 1
  double omega = 1.0;   ///< damped frequency, rad per sample, 0 < ω < π

  static constexpr ProcessInfo kInfo{"RES", "resonance",
                                     "A mechanical or electronic resonance that noise keeps "
                                     "ringing: sensing element, mount, bench."};
  friend bool operator==(const Resonance&, const Resonance&) = default;

  std::vector<ParameterInfo> parameters() const;
  std::vector<double> values() const { return {sigma2, r, omega}; }
  void set_values(std::span<const double> v) {
    sigma2 = v[0];
    r = v[1];
    omega = v[2];
  }
  Eigen::ArrayXd shape(HalfWidths m) const;
  Eigen::ArrayXXd shape_jacobian(HalfWidths m) const;
  double spectrum(const Frequency& f) const;
  /// The same at many frequencies.
  Eigen::ArrayXd spectra(const Frequencies& f) const {
    const Line all = line();
    return all.power /
           (all.steepness * (2.0 * f.half_sines().square() - all.centre).square() + all.floor);
  }
  /// The spectrum is power/(steepness (v - centre)² + floor) at v = 1 - cos 2πf.
  struct Line {
    double power;
    double steepness;
    double centre;
    double floor;
  };
  Line line() const;
  /// Whether its spectrum has a peak beside frequency 0. If not, it falls off like noise behind two
  /// lags.
  bool has_peak() const { return (1.0 + r * r) * std::cos(omega) < 2.0 * r; }
  SumCovariance sum_covariance() const;
  std::vector<DerivedQuantity> derived(Hertz rate) const;
  std::vector<std::vector<double>> scan(const Scales& scales) const;
  SecondOrderRecursion recursion(RandomStream& rng) const;
};

}  // namespace imunoise
