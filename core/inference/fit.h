#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/estimate/estimators.h"
#include "core/inference/goodness.h"

namespace imunoise {

/// What the data say about a parameter.
enum class Observability {
  kObserved,
  kUpperBound,         ///< its interval reaches zero: only the upper end means something
  kIndistinguishable,  ///< another term explains the same scales as well
  kGiven,              ///< the user gave the value
};

struct ParameterEstimate {
  double value = 0.0;
  double standard_error = 0.0;  ///< infinite when indistinguishable
  double lower = 0.0;           ///< confidence interval; infinite where nothing is known
  double upper = 0.0;
  Observability observability = Observability::kObserved;
};

/// A derived quantity with its interval.
struct DerivedEstimate {
  Coefficient coefficient;
  double value;
  double lower;
  double upper;
};

/// A fit with everything inference adds to it.
struct Fit {
  Estimate estimate;
  double confidence = 0.95;
  std::vector<std::vector<ParameterEstimate>> parameters;  ///< a row a term, in its order
  std::vector<std::vector<DerivedEstimate>> derived;       ///< a row a term
  /// Does the model fit all replicates? Made at the estimate with full weights, whatever the
  /// weights of the fit.
  TestOutcome goodness;
  MomentCovariances covariances;          ///< V(θ̂) of the moments of each replicate
  std::vector<Eigen::ArrayXd> residuals;  ///< a row a replicate: (ν̂ - ν)/√V_jj
  std::vector<std::vector<bool>> tested;  ///< a row a replicate: scales that the test uses
};

/// Sandwich covariance of the parameters, intervals (on a logarithmic or logit scale where the
/// parameter is seen, so that they respect its bounds), goodness of fit. Same replicates as the
/// estimate was made from.
Fit infer(Estimate estimate, std::span<const WaveletVariance> replicates, double confidence = 0.95);
/// The same for AGMWM: intervals from the average of the K separate covariances over K, misfit
/// summed.
Fit infer(const AverageEstimate& average, std::span<const WaveletVariance> replicates,
          double confidence = 0.95);

/// How many times longer each replicate would have to be for the interval of a parameter to leave
/// zero, if its value is what was estimated: 1 when it is seen already, 0 when that cannot be said
/// (a value of zero, or more than 256 times). Costs a few covariances of moments.
double record_longer(const Fit& fit, std::span<const WaveletVariance> replicates, std::size_t term,
                     std::size_t parameter);

}  // namespace imunoise
