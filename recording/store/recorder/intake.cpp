#include "recording/store/recorder/intake.h"

#include <cassert>
#include <utility>

namespace imunoise::recording {

Intake::Intake(const v1::RecordedDevice& device, std::uint64_t capacity_rows)
    : device_(device), capacity_(capacity_rows) {
  for (const v1::RecordedStream& stream : device_.streams()) {
    refused_.push_back(empty_rows(stream));
  }
  with_journal_.assign(refused_.size(), 0);
  counts_.resize(refused_.size());
}

bool Intake::has_room(std::size_t rows) const {
  return waiting_.empty() || rows_ + rows <= capacity_;
}

void Intake::add(Block block) {
  assert(has_room(block.rows.size()));
  StreamCounts& counts = counts_[block.stream];
  counts.received += block.rows.received;
  add_refusals(counts.refused, block.rows.refused);
  Rows& refused = refused_[block.stream];
  if (refused.received > 0) {
    if (block.rows.size() > 0) block.rows.flags.front() |= kLostBefore;
    block.rows.received += refused.received;
    add_refusals(block.rows.refused, refused.refused);
    refused.received = 0;
    refused.refused.clear();
  }
  rows_ += block.rows.size();
  waiting_.push_back(std::move(block));
}

void Intake::refuse(const Block& block) {
  std::vector<Refusal> refusals = block.rows.refused;
  if (block.rows.size() > 0) {
    add_refusals(refusals, {{Refused::kOverrun, "", block.rows.size()}});
  }
  StreamCounts& counts = counts_[block.stream];
  counts.received += block.rows.received;
  add_refusals(counts.refused, refusals);
  refused_[block.stream].received += block.rows.received;
  add_refusals(refused_[block.stream].refused, refusals);
}

std::deque<Block> Intake::take() {
  for (const Block& block : waiting_) with_journal_[block.stream] += block.rows.size();
  rows_ = 0;
  return std::exchange(waiting_, {});
}

void Intake::acknowledge() {
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    counts_[i].stored += std::exchange(with_journal_[i], 0);
  }
}

void Intake::flush_refusals() {
  for (std::size_t i = 0; i < refused_.size(); ++i) {
    if (refused_[i].received == 0) continue;
    const v1::RecordedStream& stream = device_.streams(static_cast<int>(i));
    waiting_.push_back({i, std::exchange(refused_[i], empty_rows(stream))});
  }
}

void Intake::give_up() {
  for (StreamCounts& counts : counts_) {
    const std::uint64_t settled = counts.stored + refused_rows(counts.refused);
    if (counts.received > settled) {
      add_refusals(counts.refused, {{Refused::kNotWritten, "", counts.received - settled}});
    }
  }
}

}  // namespace imunoise::recording
