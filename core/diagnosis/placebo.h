#pragma once

#include <vector>

#include "core/regression/current.h"
#include "core/search/suggestion.h"

namespace imunoise {

enum class Placebos {
  kAll,
  kSigns,  ///< what a coupling gains; not what else it could be
};

/// Tests the best regressors among tried terms against placebos, and sorts again.
///
/// Copies: the regressor of another replicate in place of each one's own. If copies explain as
/// much, what all replicates have in common does: it counts once, and any quantity that takes that
/// course each time explains it as well (Hurlbert 1984, Ecol. Monogr. 54:187: pseudo-replication).
///
/// Signs: the products of regressor and noise, one a frequency, with random signs. Their scatter
/// says how much a coupling gains by chance if the noise is not what the model says there (White
/// 1980, Econometrica 48:817); a coupling that a few frequencies show is known by so few degrees of
/// freedom. It counts where it is beyond chance.
///
/// `tried`: best first, and so they are again. `least`: the logarithm of the p-value that makes a
/// term worth testing.
void test_placebos(std::vector<TriedTerm>& tried, const Current& current, double least,
                   Placebos which, const Progress& progress = {});

}  // namespace imunoise
