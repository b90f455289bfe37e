#pragma once

// Replicates as they are studied: cut where the output stood still, mended where samples are wrong.

#include <string>
#include <vector>

#include "core/effect/subject.h"
#include "recording/import/table/channel.h"

namespace imunoise::study {

struct SoundParts {
  std::vector<recording::Replicate> replicates;  ///< share the samples that nothing was done to
  std::vector<Part> places;                      ///< of each in what was recorded
  std::vector<std::string> notes;                ///< what was done, a sentence each
  bool changed = false;                          ///< something was cut or replaced
};

/// Cuts each replicate where its channel `channel` stands still, all channels alike; parts too
/// short for a spectrum are left out (if that leaves nothing, nothing is cut). Samples of that
/// channel that repeat the one before, or lie at an end of the range, are then mended() unless they
/// are too many.
SoundParts sound_parts(const std::vector<recording::Replicate>& replicates, std::size_t channel);

}  // namespace imunoise::study
