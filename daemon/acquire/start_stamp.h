#pragma once

// When a replicate began.

#include "daemon/acquire/clock.h"
#include "imunoise/v1/recording.pb.h"

namespace imunoise::acquire {

/// Writes down when a replicate begins: its time of day, and what tells it apart should that be
/// wrong.
void stamp_start(v1::ReplicateNote& note, const Clock& clock);

}  // namespace imunoise::acquire
