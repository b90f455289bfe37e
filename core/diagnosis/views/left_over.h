#pragma once

#include <vector>

#include "core/diagnosis/views/run_off.h"
#include "core/estimate/estimators.h"
#include "core/wavelet/wavelet_variance.h"

namespace imunoise {

struct FittedModel;

/// What the effects of a model leave of the replicates: moments and drift of it.
struct LeftOver {
  std::vector<WaveletVariance> variances;  ///< a replicate each
  MomentCovariances covariances;           ///< of these, under the noise that all share
  std::vector<RunOff> run_off;
};
LeftOver left_over(const FittedModel& fitted);

/// Mean square of the whitened normal scores of the wavelet variance on the replicates that the
/// model was fitted to, with the effects taken out: 1.0 is the noise floor. A replicate with noise
/// of its own is compared with that; its scores' correlations are those of the noise that all
/// share. `left`: left_over() of it.
double training_error(const FittedModel& fitted, const LeftOver& left);

}  // namespace imunoise
