#pragma once

#include <cmath>
#include <complex>
#include <numbers>

#include "core/process/contract.h"
#include "core/process/linear_system.h"

namespace imunoise {

/// The autocovariance of white noise of variance one behind a low-pass filter:
/// γ(h) = white · [h = 0] + Σ Re(amplitude · exp(-rate · h)).
struct LowPassCovariance {
  struct Part {
    std::complex<double> amplitude;
    std::complex<double> rate;
    std::complex<double> amplitude_slope;  ///< by the cut-off
    std::complex<double> rate_slope;
    std::complex<double> one_minus_root;  ///< 1 - exp(-rate)
  };
  double white = 0.0;
  double white_slope = 0.0;
  std::vector<Part> parts{};

  Eigen::ArrayXd variance(HalfWidths m) const;  ///< Haar wavelet variance
  Eigen::ArrayXd slope(HalfWidths m) const;     ///< its derivative by the cut-off
  SumCovariance sum_covariance() const;
};

/// A filter in front of the converter: |H(w)|² = 1/(1 + (w/Ω)^2n) (Butterworth 1930). What lies
/// beyond half the sampling rate folds back.
struct AnalogLowPass {
  static constexpr ProcessInfo kInfo{
      "LOWPASS", "low-pass filter",
      "White noise through an analog Butterworth filter, or one that runs much faster than the "
      "recording: the bandwidth of the sensor.",
      "order of the filter"};
  static constexpr int kSmallest = 2;  // of first order it is GM

  static double gain(int order, double omega, const Frequency& f);
  static LowPassCovariance covariance(int order, double omega);
  static LinearSystem system(int order, double omega);
};

/// A filter that runs at the rate of the recording: the bilinear transform of a Butterworth filter,
/// |H|² = 1/(1 + (tan(θ/2)/tan(Ω/2))^2n).
struct DigitalLowPass {
  static constexpr ProcessInfo kInfo{
      "BUTTERWORTH", "digital low-pass filter",
      "White noise through a Butterworth filter that runs at the rate of the recording, as drivers "
      "and flight controllers have them.",
      "order of the filter"};
  static constexpr int kSmallest = 1;

  static double gain(int order, double omega, const Frequency& f);
  static LowPassCovariance covariance(int order, double omega);
  static LinearSystem system(int order, double omega);
};

/// White noise of variance σ² through a Butterworth low-pass filter of known order and unit gain at
/// frequency 0.
template <class Form>
struct LowPass {
  double sigma2 = 1.0;  ///< of the noise before the filter
  double omega = 0.5;   ///< cut-off Ω, half of the power, rad per sample, 0 < Ω < π
  int order = 2;

  static constexpr ProcessInfo kInfo = Form::kInfo;
  static constexpr int kSmallest = Form::kSmallest;
  static constexpr int kLargest = 8;
  friend bool operator==(const LowPass&, const LowPass&) = default;

  static LowPass with_structure(int n) { return {1.0, 0.5, n}; }
  int structure() const { return order; }

  std::vector<ParameterInfo> parameters() const {
    return {{"sigma2", "variance of the noise before the filter"},
            {"omega", "cut-off frequency in radians per sample", Dimension::kPurePerSample, 1e-4,
             std::numbers::pi - 1e-3, true}};
  }
  std::vector<double> values() const { return {sigma2, omega}; }
  void set_values(std::span<const double> v) {
    sigma2 = v[0];
    omega = v[1];
  }
  Eigen::ArrayXd shape(HalfWidths m) const { return Form::covariance(order, omega).variance(m); }
  Eigen::ArrayXXd shape_jacobian(HalfWidths m) const {
    return Form::covariance(order, omega).slope(m);
  }
  double spectrum(const Frequency& f) const { return sigma2 * Form::gain(order, omega, f); }
  SumCovariance sum_covariance() const {
    return Form::covariance(order, omega).sum_covariance().scaled(sigma2);
  }
  std::vector<DerivedQuantity> derived(Hertz rate) const {
    return {{Coefficient::kRandomWalk, std::sqrt(sigma2 / rate.value)},
            {Coefficient::kCutoff, omega * rate.value / (2.0 * std::numbers::pi)}};
  }
  std::vector<std::vector<double>> scan(const Scales& scales) const {
    const double slowest = scales.empty() ? 1.0 : 1.0 / static_cast<double>(scales.largest());
    std::vector<std::vector<double>> out;
    for (double at = 2.8; at > std::max(slowest, 1e-3); at /= 1.4) out.push_back({at});
    return out;
  }
  LinearSystem system() const { return Form::system(order, omega); }
  LinearSystem::Recursion recursion(RandomStream& rng) const {
    return system().recursion(std::sqrt(sigma2), rng);
  }
};

using AnalogFilter = LowPass<AnalogLowPass>;
using DigitalFilter = LowPass<DigitalLowPass>;

}  // namespace imunoise
