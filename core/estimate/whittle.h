#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/estimate/problem.h"
#include "core/model/model.h"
#include "core/spectrum/banded_power.h"
#include "core/support/progress.h"

namespace imunoise {

/// Whittle's likelihood: coefficients of the cosine transform are taken as independent, with the
/// model's spectrum as variance. A ramp (DR) is their mean; each replicate's runs up or down.

/// -log likelihood in nats, less what does not depend on the model: Σ n/2 (log S + P/S). Infinite
/// where the model has no power.
double whittle_objective(const Model& model, std::span<const BandedPower> replicates);

/// Fisher information of the parameters named by their column (of all terms, in order; per sample,
/// as in the grammar): columns × columns. Its inverse is the Cramér-Rao bound.
Eigen::MatrixXd whittle_information(const Model& model, std::span<const BandedPower> replicates,
                                    const std::vector<Eigen::Index>& columns);

/// Its root for one replicate, without its rows for ramps: how the logarithm of each band's power
/// moves with each parameter, over its standard error √(2/count). Bands × columns.
Eigen::MatrixXd whittle_slopes(const Model& model, const BandedPower& bands,
                               const std::vector<Eigen::Index>& columns);

struct WhittleEstimate {
  Model model;  ///< sorted
  double objective = 0.0;
  Termination termination = Termination::kConverged;
};

/// Where a search for a maximum begins.
enum class Begin {
  kAnywhere,  ///< shapes may be lost, see maximise()
  kNear,      ///< at the maximum of a likelihood much like this one
};

/// Maximum of the likelihood next to `start`, whose values are all set: Fisher scoring, powers ≥ 0.
/// Given parameters stay. Efficient where the model is right; where it is not, the many
/// coefficients of high frequencies decide, while moments weigh every octave. The way leads through
/// wider bands, where it is quick; what is narrower than these moves at its end.
WhittleEstimate whittle(const Model& start, std::span<const BandedPower> replicates,
                        const Progress& progress = {}, Begin begin = Begin::kAnywhere);

}  // namespace imunoise
