#pragma once

#include <optional>
#include <vector>

#include "core/regression/fitted_model.h"

namespace imunoise {

/// Log-likelihood of data that a model was not fitted to.
struct HeldOut {
  /// Of a replicate each, or of a block of a single one; less what does not depend on the model.
  std::vector<double> nats;
  std::vector<Eigen::Index> samples;  ///< of each of these
  /// Averaging times × replicates: how many scores of the wavelet variance there are.
  Eigen::Index scores = 0;

  double total_likelihood() const;
};

/// Each replicate by a fit to the others; of a single replicate each of four blocks, which is
/// weaker: what holds throughout that hour is not seen to hold in another. Coefficients that belong
/// to the held-out replicate alone (phases, steps) are estimated there, and each costs a nat.
/// Powers that a replicate has of its own must prove themselves on each of its quarters, by a fit
/// to the other three. Nothing where nothing can be held out: of blocks that are too short.
std::optional<HeldOut> held_out(const FittedModel& fitted);

}  // namespace imunoise
