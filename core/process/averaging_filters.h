#pragma once

#include <cmath>

#include "core/process/finite_memory.h"

namespace imunoise {

/// Taps of a running mean over n samples, and of two of them in cascade (2n - 1 triangular taps).
std::vector<double> boxcar_taps(int n);
std::vector<double> bartlett_taps(int n);

/// White noise of variance σ² through a filter of unit gain whose length is known: the device's
/// own.
template <class Form>
struct AveragingFilter {
  double sigma2 = 1.0;  ///< of the noise before the filter
  int length = 2;

  static constexpr ProcessInfo kInfo = Form::kInfo;
  static constexpr int kMostTaps = 4096;
  friend bool operator==(const AveragingFilter&, const AveragingFilter&) = default;

  static AveragingFilter with_structure(int n) { return {1.0, n}; }
  int structure() const { return length; }

  std::vector<ParameterInfo> parameters() const {
    return {{"sigma2", "variance of the noise before the filter"}};
  }
  std::vector<double> values() const { return {sigma2}; }
  void set_values(std::span<const double> v) { sigma2 = v[0]; }
  FiniteMemory filter() const { return FiniteMemory(Form::taps(length)); }
  Eigen::ArrayXd shape(HalfWidths m) const { return filter().variance(m); }
  Eigen::ArrayXXd shape_jacobian(HalfWidths m) const { return no_shape_jacobian(m); }
  double spectrum(double f) const { return sigma2 * filter().spectrum(f); }
  SumCovariance sum_covariance() const { return filter().sum_covariance().scaled(sigma2); }
  std::vector<DerivedQuantity> derived(Hertz rate) const {
    return {{Coefficient::kRandomWalk, std::sqrt(sigma2 / rate.value)}};
  }
  std::vector<std::vector<double>> scan(const Scales&) const { return {{}}; }
  FiniteMemory::Recursion recursion(RandomStream& rng) const {
    return filter().recursion(std::sqrt(sigma2), rng);
  }
};

struct BoxcarForm {
  static constexpr ProcessInfo kInfo{
      "MAVG", "moving-average filter",
      "White noise through the device's running mean over a known number of samples.",
      "samples averaged"};
  static std::vector<double> taps(int n) { return boxcar_taps(n); }
};

struct BartlettForm {
  static constexpr ProcessInfo kInfo{
      "BARTLETT", "Bartlett filter",
      "White noise through two running means in cascade, the on-chip filter of many MEMS sensors.",
      "samples averaged in each of the two stages"};
  static std::vector<double> taps(int n) { return bartlett_taps(n); }
};

using MovingAverageFilter = AveragingFilter<BoxcarForm>;
using BartlettFilter = AveragingFilter<BartlettForm>;

}  // namespace imunoise
