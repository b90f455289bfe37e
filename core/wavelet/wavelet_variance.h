#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "core/signal/signal.h"
#include "core/support/progress.h"
#include "core/wavelet/scales.h"

namespace imunoise {

/// Measured Haar MODWT wavelet variance of one signal: ν̂(m) = mean_t W_t², with
/// W_t = (S_t - 2 S_{t-m} + S_{t-2m}) / (2m) over the M = T - 2m + 1 coefficients inside the
/// signal. Half the Allan variance at m samples. Arrays have one entry a scale; variances in (SI
/// unit)².
struct WaveletVariance {
  Scales scales;
  Eigen::ArrayXd variance;
  Eigen::ArrayXd lower;  ///< Confidence interval, χ² with edof degrees of freedom
  Eigen::ArrayXd upper;
  Eigen::ArrayXd
      edof;  ///< Equivalent degrees of freedom max(M / 2m, 1) (Percival & Walden 2000, η3)
  double confidence = 0.95;
  double efficiency =
      1.0;  ///< Of the estimator at the normal distribution; 1 for the classical one
  std::size_t samples = 0;  ///< T
  Hertz rate;
  Quantity quantity = Quantity::kUnknown;
};

/// The classical estimator. Precondition: T ≥ 2m for the largest scale. Integer samples are summed
/// exactly; the result does not depend on the number of threads or on the processor.
/// 22 scales of 1e7 samples take about the time of ten reads of the memory. Thread-safe.
WaveletVariance wavelet_variance(const Signal& signal, const Scales& scales,
                                 double confidence = 0.95, const Progress& progress = {});

/// Some of the scales of a classical estimate. Precondition: it has them.
WaveletVariance at_scales(const WaveletVariance& wv, const Scales& scales);

/// Equivalent degrees of freedom max(M/2m, 1) of each scale (Percival & Walden 2000, η3).
Eigen::ArrayXd equivalent_degrees(const Scales& scales, std::size_t samples);
/// Fills edof from scales and samples, and then the interval.
void set_chi_square_interval(WaveletVariance& wv);
/// Fills lower and upper from variance, edof, confidence and efficiency. The robust estimator's
/// interval is the classical one widened by 1/√efficiency about the estimate.
void fill_interval(WaveletVariance& wv);

}  // namespace imunoise
