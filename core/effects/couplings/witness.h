#pragma once

// What the effect `witness` and its search share.

#include "core/effect/effect.h"
#include "core/effect/subject.h"
#include "core/search/suggestion.h"

namespace imunoise::effects {

enum WitnessParameter : std::size_t {
  kWitnessLag,
  kWitnessFrom,
  kWitnessTo,
  kWitnessOctaves,
  kWitnessQuadratic,
  kWitnessVertex,
  kWitnessDerivative,
  kWitnessOwn,
  kWitnessNoise,
  kWitnessCoefficient,
};

const Effect& witness();

/// What was taken off a replicate of a channel; 0 where nothing was.
double level(const Witness& channel, std::size_t replicate);
/// Over the replicates.
double mean_level(const Witness& channel);

/// Each witness as it is, less noise of its own, at some frequencies, behind a lag, squared, and
/// its change.
Suggestions search_witness(const SearchView& view);

}  // namespace imunoise::effects
