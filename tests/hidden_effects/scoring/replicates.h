#pragma once

#include <vector>

#include "recording/import/table/channel.h"
#include "tests/hidden_effects/generator/recording.h"

namespace imunoise::hidden {

/// Generated recordings as an import would give them. Precondition: every unit is one that the
/// house knows.
std::vector<recording::Replicate> to_replicates(const std::vector<Recording>& recordings,
                                                double rate_hz);

}  // namespace imunoise::hidden
