#pragma once

#include "tests/hidden_effects/generator/scene.h"

namespace imunoise::hidden {

/// A scene of real recordings: gyro_x as measured (its own first 2^k samples, the same k in all
/// replicates), with drawn surroundings and their witnesses beside it. The spectrum that sets
/// strengths is the recordings' own, averaged over replicates and over bands of a tenth of an
/// octave; lines in it count as noise. `base` and `neighbour` are unknown and stay empty: for
/// effects of the mean only.
Scene borrow_scene(std::vector<Series> measured, double rate_hz, RandomStream random);

}  // namespace imunoise::hidden
