#pragma once

#include <span>

#include "core/effect/effect_term.h"
#include "core/estimate/whittle.h"

namespace imunoise::effects {

/// What the term own_powers gives a replicate of its own: a fit of the powers of a noise model with
/// all that is not a power held as it is, or with `shapes` of the whole model.
WhittleEstimate own_noise_of(const EffectTerm& term, const Model& noise,
                             std::span<const BandedPower> measured);

}  // namespace imunoise::effects
