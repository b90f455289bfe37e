#pragma once

#include <vector>

#include "core/diagnosis/views/run_off.h"
#include "core/wavelet/wavelet_variance.h"

namespace imunoise {

/// Log-likelihood of data that a model was not fitted to.
struct HeldOut {
  /// Of a replicate each, or of a block of a single one; less what does not depend on the model.
  std::vector<double> nats;
  /// Averaging times × replicates: how many scores of the wavelet variance there are.
  Eigen::Index scores = 0;

  double total_likelihood() const;
};

/// What the effects of a model leave of the replicates: moments and drift of it.
struct LeftOver {
  std::vector<WaveletVariance> variances;  ///< a replicate each
  std::vector<RunOff> run_off;
};
LeftOver left_over(const FittedModel& fitted);

/// True where something can be held out: replicates, or blocks of a single one that is long enough;
/// with powers of its own, blocks of each.
bool can_hold_out(const FittedModel& fitted);

/// Mean square of the whitened normal scores of the wavelet variance on the replicates that the
/// model was fitted to, with the effects taken out: 1.0 is the noise floor. `left`: left_over() of
/// it.
double training_error(const FittedModel& fitted, const LeftOver& left);

/// Each replicate by a fit to the others; of a single replicate each of four blocks, which is
/// weaker: what holds throughout that hour is not seen to hold in another. Coefficients that belong
/// to the held-out replicate alone (phases, steps) are estimated there, and each costs a nat.
/// Powers that a replicate has of its own must prove themselves on each of its quarters, by a fit
/// to the other three. Precondition: can_hold_out().
HeldOut held_out(const FittedModel& fitted);

}  // namespace imunoise
