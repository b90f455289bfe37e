#pragma once

// The bounded queue between the reader of a device and the journal, and the count of every row that
// passes or does not.

#include <deque>
#include <vector>

#include "recording/store/recorder/recorder.h"

namespace imunoise::recording {

/// One device's. Not thread-safe: the recorder's lock guards it.
class Intake {
 public:
  Intake(const v1::RecordedDevice& device, std::uint64_t capacity_rows);

  /// True when a block of so many rows may be added. An empty queue takes a block of any size.
  bool has_room(std::size_t rows) const;
  /// True when so much waits that the journal should take it soon.
  bool presses() const { return rows_ > capacity_ / 4; }
  /// Adds a block, with what was refused since the last one. Precondition: has_room().
  void add(Block block);
  /// Counts the rows of a block that found no room as refused.
  void refuse(const Block& block);

  bool empty() const { return waiting_.empty(); }
  /// Hands out all blocks: they are with the journal now.
  std::deque<Block> take();
  /// When the journal has acknowledged what it took: those rows are stored.
  void acknowledge();
  /// At the end: refusals that no block carries yet, as blocks without rows.
  void flush_refusals();
  /// At the end: what was neither stored nor refused is refused now.
  void give_up();

  const std::vector<StreamCounts>& counts() const { return counts_; }

 private:
  v1::RecordedDevice device_;
  std::uint64_t capacity_;
  std::uint64_t rows_ = 0;  // waiting
  std::deque<Block> waiting_;
  std::vector<Rows> refused_;                // of each stream: refusals that no block carries yet
  std::vector<std::uint64_t> with_journal_;  // of each stream: rows not acknowledged
  std::vector<StreamCounts> counts_;
};

}  // namespace imunoise::recording
