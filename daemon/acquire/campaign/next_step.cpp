#include "daemon/acquire/campaign/next_step.h"

#include <cmath>

namespace imunoise::acquire {
namespace {

std::chrono::nanoseconds seconds(double count) {
  return std::chrono::nanoseconds(std::llround(count * 1e9));
}

// When the recording after this one begins; nothing when there is none.
std::optional<Time> next_start(const v1::Campaign& campaign, const RecordingState& newest,
                               const Memory& memory) {
  if (memory.once_since) {
    // Names are whole seconds; where the clock was set meanwhile, both are known less exactly.
    constexpr std::chrono::milliseconds kHalf{500};
    return newest.started + kHalf < *memory.once_since ? memory.once_since : std::nullopt;
  }
  if (!campaign.schedule().has_every_s()) return std::nullopt;
  return newest.started + seconds(campaign.schedule().every_s());
}

Step record(const v1::Campaign& campaign, const RecordingState& state, const Memory& memory,
            Time now) {
  const Time at_rest = memory.at_rest_since.value_or(now) + seconds(campaign.settling_s());
  if (now < at_rest) return {.phase = v1::settling, .until = at_rest};
  if (memory.replicate_ended) {
    const Time go_on = *memory.replicate_ended + seconds(campaign.pause_s());
    if (now < go_on) return {.phase = v1::pausing, .until = go_on};
  }
  return {.phase = v1::recording,
          .replicate = good_replicates(campaign, state.notes) + 1,
          .attempt = state.last_replicate + 1};
}

Step begin(const v1::Campaign& campaign, const Memory& memory, Time now) {
  Step out = record(campaign, {}, memory, now);
  out.new_recording = true;
  return out;
}

}  // namespace

void shift(Memory& memory, std::chrono::nanoseconds leap) {
  for (std::optional<Time>* const one : {&memory.at_rest_since, &memory.replicate_ended,
                                         &memory.held_up_until, &memory.once_since}) {
    if (*one) **one += leap;
  }
}

std::uint32_t good_replicates(const v1::Campaign& campaign,
                              const std::vector<v1::ReplicateNote>& notes) {
  std::uint32_t good = 0;
  std::uint32_t repeats = 0;  // of the replicate that is next to count
  for (const v1::ReplicateNote& note : notes) {
    if (note.state() != v1::complete) continue;
    const bool again = campaign.stillness().repeat_disturbed() && note.disturbances_size() > 0 &&
                       repeats < campaign.stillness().repeats();
    repeats = again ? repeats + 1 : 0;
    if (!again) ++good;
  }
  return good;
}

Step next_step(const v1::Campaign& campaign, const std::optional<RecordingState>& newest,
               const Memory& memory, Time now) {
  if (memory.held_up_until && now < *memory.held_up_until) {
    return {.phase = v1::held_up, .until = memory.held_up_until};
  }
  if (!newest) return begin(campaign, memory, now);
  const std::optional<Time> start = next_start(campaign, *newest, memory);
  if (good_replicates(campaign, newest->notes) < campaign.replicates()) {
    // Replicates of one recording belong together: what waited until the next is due stays as it
    // is.
    const bool too_late = start && !memory.once_since && now >= *start;
    return too_late ? begin(campaign, memory, now) : record(campaign, *newest, memory, now);
  }
  if (!memory.calibrated) return {.phase = v1::calibrating};
  if (!memory.published) return {.phase = v1::publishing};
  if (!start) return {.phase = v1::finished};
  const Time settle = *start - seconds(campaign.settling_s());
  if (now < settle) return {.phase = v1::waiting, .until = settle};
  return begin(campaign, memory, now);
}

}  // namespace imunoise::acquire
