#pragma once

// What is left of replicates whose output stood still.

#include <string>
#include <vector>

#include "recording/import/channel.h"

namespace imunoise::study {

struct SoundParts {
  std::vector<recording::Replicate> replicates;  ///< share their samples with those they are of
  std::vector<std::string> notes;                ///< what was cut, a sentence each
};

/// Cuts each replicate where its channel `channel` stands still, all channels alike; parts too
/// short for a spectrum are left out. Where nothing stands still, or nothing would be left, the
/// replicates are as they were.
SoundParts sound_parts(const std::vector<recording::Replicate>& replicates, std::size_t channel);

}  // namespace imunoise::study
