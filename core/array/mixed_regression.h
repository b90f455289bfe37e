#pragma once

#include <cstdint>
#include <vector>

#include "core/array/array_estimate.h"
#include "core/array/banded_regression.h"

namespace imunoise {

struct RegressionOptions {
  double confidence = 0.95;
  std::size_t bootstraps = 199;  ///< 0: no bootstrap, and no robust intervals
  std::uint64_t seed = 1;
};

/// One coefficient by one method.
struct CoefficientEstimate {
  double value = 0.0;
  double standard_error = 0.0;
  double lower = 0.0;  ///< confidence interval
  double upper = 0.0;
  double p_value = 1.0;  ///< that the coefficient is zero
};

/// A regression with its noise.
struct MixedRegression {
  ArrayFit noise;                        ///< of the residuals, at the maximum of the likelihood
  std::vector<CoefficientEstimate> gls;  ///< under the noise; p by the bootstrap where there is one
  std::vector<CoefficientEstimate> robust;  ///< Huber's; error and p by the bootstrap; else empty
  std::vector<CoefficientEstimate> naive;   ///< as if all samples were independent: for comparison
  Eigen::VectorXd constants;                ///< of each series, with the GLS coefficients
  /// Share of the variance that the recording shows of each series (a row): of the regressors
  /// together, then of each term of the model as it is written. Rows sum to 1.
  Eigen::MatrixXd explained;
};

/// Regression with latent processes that series share, own or have in groups (MiGMWM): noise from
/// the moments of the residuals, then by likelihood; coefficients by GLS under it; twice round. The
/// test of a coefficient is a parametric bootstrap of its t statistic: series are simulated from
/// the fitted noise without any effect, and everything is estimated again (the noise by one scoring
/// step, which is equivalent to first order). Results do not depend on the number of threads.
/// Preconditions: a quick_length() of samples, of at least 16; a model that has_likelihood();
/// scales enough for it.
MixedRegression mixed_regression(const Model& written, const ArrayLayout& layout,
                                 const RegressionData& data, const RegressionOptions& options = {},
                                 const Progress& progress = {});

}  // namespace imunoise
