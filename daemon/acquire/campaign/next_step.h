#pragma once

// What a campaign does next: a pure function of its configuration, of what is on disk, of what this
// process has done since it began, and of the time.

#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/acquire/clock.h"
#include "imunoise/v1/campaign.pb.h"
#include "imunoise/v1/recording.pb.h"

namespace imunoise::acquire {

/// The newest recording, as its manifest tells it.
struct RecordingState {
  Time started;
  std::vector<v1::ReplicateNote> notes;  ///< In order.
  std::uint32_t last_replicate = 0;      ///< Highest number that is taken; 0: none.
};

/// What a restart forgets, and does again.
struct Memory {
  std::optional<Time> at_rest_since;    ///< The sensors settle from then on.
  std::optional<Time> replicate_ended;  ///< The pause counts from then on.
  bool calibrated = false;
  bool published = false;
  std::optional<Time> held_up_until;  ///< Something went wrong; not again before.
  /// Set: one recording is made if the newest began before, whatever the schedule says, and then
  /// no more.
  std::optional<Time> once_since;
};

/// The same moments by a clock that was set by so much.
void shift(Memory& memory, std::chrono::nanoseconds leap);

struct Step {
  v1::CampaignPhase phase = v1::finished;
  std::optional<Time> until = {};  ///< Of settling, pausing, waiting and being held up.
  bool new_recording = false;      ///< This step belongs to a recording that is not on disk yet.
  std::uint32_t replicate = 0;     ///< Of recording: this one of the campaign's, from 1.
  std::uint32_t attempt = 0;       ///< Of recording: its number on disk.
};

/// Replicates that count: complete, and not to be repeated because they were disturbed.
std::uint32_t good_replicates(const v1::Campaign& campaign,
                              const std::vector<v1::ReplicateNote>& notes);

Step next_step(const v1::Campaign& campaign, const std::optional<RecordingState>& newest,
               const Memory& memory, Time now);

}  // namespace imunoise::acquire
