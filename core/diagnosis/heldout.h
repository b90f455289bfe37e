#pragma once

#include <vector>

#include "core/diagnosis/views/run_off.h"
#include "core/wavelet/wavelet_variance.h"

namespace imunoise {

/// How a model does on replicates, one number a replicate.
struct Errors {
  /// Mean square of the whitened normal scores of the wavelet variance, with the effects taken out:
  /// 1.0 is the noise floor.
  std::vector<double> error;
  std::vector<double> log_likelihood;  ///< nats, less what does not depend on the model

  double mean_error() const;
  /// Standard error of the mean; 0 with one replicate.
  double error_of_mean() const;
  double total_likelihood() const;
};

/// What the effects of a model leave of the replicates: moments and drift of it.
struct LeftOver {
  std::vector<WaveletVariance> variances;  ///< a replicate each
  std::vector<RunOff> run_off;
};
LeftOver left_over(const FittedModel& fitted);

/// True where something can be held out: replicates, or blocks of a single one that is long enough;
/// and no parameters of their own.
bool can_hold_out(const FittedModel& fitted);

/// On the replicates that the model was fitted to. `left`: left_over() of it.
Errors training_errors(const FittedModel& fitted, const LeftOver& left);

/// On each replicate by a fit to the others; of a single replicate on each of four blocks, which is
/// weaker: what holds throughout that hour is not seen to hold in another. Coefficients that belong
/// to the held-out replicate alone (phases, steps) are estimated there, and each costs a nat.
/// Precondition: can_hold_out().
Errors heldout_errors(const FittedModel& fitted);

}  // namespace imunoise
