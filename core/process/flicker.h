#pragma once

#include "core/process/contract.h"
#include "core/process/flicker_recursion.h"

namespace imunoise {

/// Flicker noise as white noise half-integrated in discrete time (Kasdin 1995): two-sided spectrum
/// B²/(2 sin πf), which is B²/(2πf) at low frequency. Compared with the flat B² ln2/π of ideal 1/f
/// noise its wavelet variance is 1.443, 1.154, 1.080, 1.050 times at m = 1..4, and 1 in the limit.
struct Flicker {
  double b2 = 1.0;  ///< B²

  static constexpr ProcessInfo kInfo{
      "FN", "flicker noise",
      "1/f noise of the electronics: the floor that averaging cannot beat, the bias instability."};
  friend bool operator==(const Flicker&, const Flicker&) = default;

  std::vector<ParameterInfo> parameters() const {
    return {{"b2", "square of the flicker coefficient B"}};
  }
  std::vector<double> values() const { return {b2}; }
  void set_values(std::span<const double> v) { b2 = v[0]; }
  Eigen::ArrayXd shape(HalfWidths m) const;
  Eigen::ArrayXXd shape_jacobian(HalfWidths m) const { return no_shape_jacobian(m); }
  double spectrum(const Frequency& f) const;
  SumCovariance sum_covariance() const { return {.flicker = b2}; }
  std::vector<DerivedQuantity> derived(Hertz rate) const;
  std::vector<std::vector<double>> scan(const Scales&) const { return {{}}; }
  FlickerRecursion recursion(RandomStream& rng) const { return {b2, rng}; }
  /// Adds one realisation of a length that is known, exactly.
  void add_samples(RandomStream& rng, std::span<double> out) const;
};

}  // namespace imunoise
