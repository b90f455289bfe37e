#pragma once

#include <cmath>

#include "core/process/finite_memory.h"

namespace imunoise {

/// A running mean over n samples: its n taps, their autocovariance at lags 0 .. n - 1, and its gain
/// in power at f cycles per sample, the square of the Dirichlet kernel sin(πfn)/(n sin πf).
std::vector<double> boxcar_taps(int n);
std::vector<double> boxcar_autocovariance(int n);
double boxcar_gain(int n, double f);
/// The same of two of them in cascade: 2n - 1 triangular taps.
std::vector<double> bartlett_taps(int n);
std::vector<double> bartlett_autocovariance(int n);
double bartlett_gain(int n, double f);

/// White noise of variance σ² through a filter of unit gain whose length is known: the device's
/// own.
template <class Form>
struct AveragingFilter {
  double sigma2 = 1.0;  ///< of the noise before the filter
  int length = 2;

  static constexpr ProcessInfo kInfo = Form::kInfo;
  static constexpr int kLargest = 4096;
  friend bool operator==(const AveragingFilter&, const AveragingFilter&) = default;

  static AveragingFilter with_structure(int n) { return {1.0, n}; }
  int structure() const { return length; }

  std::vector<ParameterInfo> parameters() const {
    return {{"sigma2", "variance of the noise before the filter"}};
  }
  std::vector<double> values() const { return {sigma2}; }
  void set_values(std::span<const double> v) { sigma2 = v[0]; }
  FiniteMemory filter() const { return {Form::taps(length), Form::autocovariance(length)}; }
  Eigen::ArrayXd shape(HalfWidths m) const { return filter().variance(m); }
  Eigen::ArrayXXd shape_jacobian(HalfWidths m) const { return no_shape_jacobian(m); }
  double spectrum(const Frequency& f) const { return sigma2 * Form::gain(length, f.cycles); }
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
  static std::vector<double> autocovariance(int n) { return boxcar_autocovariance(n); }
  static double gain(int n, double f) { return boxcar_gain(n, f); }
};

struct BartlettForm {
  static constexpr ProcessInfo kInfo{
      "BARTLETT", "Bartlett filter",
      "White noise through two running means in cascade, the on-chip filter of many MEMS sensors.",
      "samples averaged in each of the two stages"};
  static std::vector<double> taps(int n) { return bartlett_taps(n); }
  static std::vector<double> autocovariance(int n) { return bartlett_autocovariance(n); }
  static double gain(int n, double f) { return bartlett_gain(n, f); }
};

using MovingAverageFilter = AveragingFilter<BoxcarForm>;
using BartlettFilter = AveragingFilter<BartlettForm>;

}  // namespace imunoise
