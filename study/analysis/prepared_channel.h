#pragma once

// What every model of a recorded channel is judged by, worked out once.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/effect/subject.h"
#include "core/support/progress.h"
#include "core/support/result.h"
#include "core/wavelet/wavelet_variance.h"
#include "study/analysis/sound_parts.h"

namespace imunoise::study {

/// A channel's replicates without their defects, and their moments and transforms.
struct PreparedChannel {
  std::string name;
  std::vector<std::string> replicates;   ///< their names
  std::vector<std::string> notes;        ///< what was cut or mended, a sentence each
  bool changed = false;                  ///< something was
  std::vector<WaveletVariance> moments;  ///< a replicate each
  std::shared_ptr<const Subject> subject;
  std::uint32_t fingerprint = 0;  ///< tells other samples apart; 0: was not taken
};

/// A channel as it was recorded, beside others, and as it is seen.
struct RecordedChannel {
  std::vector<recording::Replicate> recorded;
  std::size_t channel = 0;
  SoundParts parts;
  PreparedChannel prepared;
};

/// Names of witnesses; unset: all channels but the one under study.
using WitnessNames = std::optional<std::vector<std::string>>;

/// Error: one that was not recorded.
Result<void> check_witnesses(const WitnessNames& witnesses, const recording::Replicate& in);

/// Error: a witness that was not recorded, replicates that are too short or tell nothing, or the
/// caller stopped it.
Result<RecordedChannel> prepare_channel(std::vector<recording::Replicate> recorded,
                                        std::size_t channel, const WitnessNames& witnesses,
                                        const Progress& progress = {});

}  // namespace imunoise::study
