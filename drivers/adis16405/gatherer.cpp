#include "drivers/adis16405/gatherer.h"

#include <utility>

namespace imunoise::drivers::adis16405 {
namespace {

// Every channel of `late` stands behind every channel of `early` in the burst.
bool is_behind(unsigned late, unsigned early) { return (late & -late) > early; }

}  // namespace

Gathered Gatherer::take(const Burst& burst) {
  const unsigned fresh = burst.is_new & channels_;
  if (fresh == channels_) {
    give_up();
    sample_ = burst;
    return Gathered::kSample;
  }
  if (fresh == 0) return Gathered::kNothingNew;
  const unsigned held = part_ ? part_->is_new & channels_ : 0U;
  if ((held | fresh) == channels_ && is_behind(held, fresh)) {
    sample_ = *std::exchange(part_, std::nullopt);
    for (std::size_t i = 0; i < kBurstChannels; ++i) {
      if ((fresh >> i & 1U) != 0) sample_.counts[i] = burst.counts[i];
    }
    sample_.alarm |= burst.alarm;
    return Gathered::kSample;
  }
  give_up();
  part_ = burst;
  return Gathered::kPart;
}

std::size_t Gatherer::take_lost() { return std::exchange(lost_, 0); }

void Gatherer::give_up() {
  if (part_) ++lost_;
  part_.reset();
}

}  // namespace imunoise::drivers::adis16405
