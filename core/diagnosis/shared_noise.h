#pragma once

#include <string>
#include <vector>

#include "core/diagnosis/candidates.h"

namespace imunoise {

/// Says of noise that only its spectrum tells that it is common vibration where another sensor of
/// the same kind feels it too: a coupling to that sensor at some frequencies, which explains more
/// than one at all of them (a leak), explains something beside the noise, and no trifle. The
/// evidence of both then counts.
///
/// If the best term is a coupling to a sensor that feels the same motion, noise is sought beside
/// it: what that sensor's own noise hides of the motion remains in the channel. Noise and coupling
/// are then one more term, with the evidence of both.
///
/// `tried`: best first, and so they are again. `searches`: how many found them. `level`:
/// false-alarm probability. `refuted`: causes of noise that is not sought beside a coupling.
/// Stopped, it names nothing more.
void name_shared_noise(std::vector<TriedTerm>& tried, double searches, double level,
                       const std::vector<std::string>& refuted = {}, const Progress& progress = {});

}  // namespace imunoise
