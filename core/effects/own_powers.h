#pragma once

#include <span>

#include "core/effect/effect_term.h"
#include "core/estimate/whittle.h"

namespace imunoise::effects {

/// What the term own_powers gives a replicate of its own: a fit of the powers of the noise that all
/// share, with all that is not a power held as it is; or with `shapes` of the whole model, where
/// the search begins at `own`.
WhittleEstimate own_noise_of(const EffectTerm& term, const Model& shared, const Model& own,
                             std::span<const BandedPower> measured);

}  // namespace imunoise::effects
