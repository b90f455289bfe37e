#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "core/wavelet/scales.h"
#include "core/wavelet/sum_covariance.h"

namespace imunoise {

/// Exact covariance V of the measured wavelet variances of one Gaussian signal of T samples:
///   V_jk = [2 Σ_s c(s) γ_jk(s)² + 4 μ_j μ_k Σ_s c(s) γ_jk(s)] / (M_j M_k),
/// c(s) = number of coefficient pairs at lag s (Percival 1995 for j = k; Zhang 2008).
/// To about 1e-9 relative (LagSums). J × J, in the square of the unit of Γ/m². Precondition: T ≥
/// 2m. Cost: milliseconds for 18 scales, tens for 64. Thread-safe.
Eigen::MatrixXd moment_covariance(const SumCovariance& process, const Scales& scales,
                                  std::size_t samples);

}  // namespace imunoise
