#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/signal/signal.h"
#include "core/support/progress.h"
#include "core/wavelet/scales.h"

namespace imunoise {

/// Measured Haar MODWT wavelet cross-covariances of I signals recorded together:
/// ν̂_ab(m) = mean_t W^a_t W^b_t over the M = T - 2m + 1 coefficients inside the signals. The
/// diagonal holds the wavelet variances. In (SI unit)², of a times b.
struct WaveletCovariance {
  Scales scales;
  std::vector<Eigen::MatrixXd> covariance;  ///< one symmetric I × I matrix a scale
  std::size_t samples = 0;                  ///< T
  Hertz rate;
  Quantity quantity = Quantity::kUnknown;  ///< of the first signal

  Eigen::Index signals() const { return covariance.empty() ? 0 : covariance.front().rows(); }
  /// The entries of one pair of signals, one a scale.
  Eigen::ArrayXd of(Eigen::Index a, Eigen::Index b) const;
};

/// Integer samples are summed exactly and coefficients formed without rounding; the result does not
/// depend on the number of threads. Precondition: at least one signal, all of one length T ≥ 2m and
/// one rate. Cost: three reads of each signal a scale and I²/2 products a coefficient; memory: a
/// few blocks a signal. Thread-safe.
WaveletCovariance wavelet_covariance(std::span<const Signal> signals, const Scales& scales,
                                     const Progress& progress = {});

/// Interval of one entry without a model: Student's, with variance (ν_aa ν_bb + ν_ab²) / n, the
/// distribution of Gaussian signals whose coefficients count as n = κM/2m ≥ 1 independent pairs. κ
/// follows from the slope of the two wavelet variances about this scale: for a power law S ~ f^α,
/// whose wavelet variance has slope s = -1 - α, κ = (4/π) (∫P)² / ∫P², P = sin⁴x · x^(α-2), which
/// is 3.00 for white, 2.34 flicker noise, 1.85 a random walk (less at m < 8). `measured`: mean of
/// `replicates`.
struct CovarianceInterval {
  Eigen::ArrayXd lower;
  Eigen::ArrayXd upper;
};
CovarianceInterval covariance_interval(const WaveletCovariance& measured, Eigen::Index a,
                                       Eigen::Index b, double confidence = 0.95,
                                       std::size_t replicates = 1);

}  // namespace imunoise
