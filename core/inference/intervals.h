#pragma once

#include <functional>

#include "core/inference/fit.h"
#include "core/inference/parameter_covariance.h"

namespace imunoise {

/// Confidence interval of parameter `index` of a process from its standard error, on the scale that
/// suits it. A power is seen where it is beyond what chance makes of none: its evidence, in
/// standard errors, is that of a power of zero, and not the error of its estimate, which grows with
/// it. The lower end of a power that is barely seen counts that it was seen.
ParameterEstimate interval(const ParameterInfo& info, std::size_t index, double value,
                           double standard_error, double confidence, double evidence);

/// Upper end of the interval of a power that may be zero, from a first guess `upper`: the largest
/// one that could have been estimated as this little. Its own standard error counts, which grows
/// with it (error_at), not the one that goes with the small estimate.
double upper_bound(double value, double upper, double z,
                   const std::function<double(double)>& error_at);

/// Standard error that a power (by its column) would have if it were worth `value`, all else as
/// fitted; infinite when it cannot be told apart.
using PowerError = std::function<double(Eigen::Index column, double value)>;

/// The evidence for a power (by its column), see interval(). `by_error`: the estimate over its
/// standard error.
using PowerEvidence = std::function<double(Eigen::Index column, double by_error)>;

/// The most that one process can have of noise whose variance is known: its wavelet variance is
/// nowhere above that of all, with four standard errors of chance.
class PowerLimit {
 public:
  /// `variance`: the wavelet variance of all noise; `samples`: of all replicates.
  PowerLimit(const std::function<Eigen::ArrayXd(HalfWidths)>& variance, double samples);
  /// Its largest power, its other parameters anywhere in their intervals.
  double most(const Process& process, const std::vector<ParameterEstimate>& estimates) const;

 private:
  Eigen::ArrayXd m_;
  Eigen::ArrayXd limit_;
};

/// Interval of a derived quantity of a term: mapped end to end when it depends on one parameter,
/// else by the delta method on the logarithm. `estimates` and `covariance` are of the term's
/// parameters; z is the normal quantile of the confidence.
DerivedEstimate derived_interval(const Term& term, const std::vector<ParameterEstimate>& estimates,
                                 const Eigen::MatrixXd& covariance, const DerivedQuantity& quantity,
                                 Hertz rate, double z);

/// Fills fit.parameters and fit.derived. `covariance` is of the interior parameters of the model,
/// in the order of `sets`; `samples` those of all replicates.
void fill_intervals(Fit& fit, const ParameterSets& sets, const ParameterCovariance& covariance,
                    const PowerError& power_error, const PowerEvidence& evidence, double samples,
                    Hertz rate);

/// Whether nothing else of its process is estimated beside a term's power.
bool alone(const Term& term);

}  // namespace imunoise
