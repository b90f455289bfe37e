#pragma once

// The journal of one device in one replicate: segments of blocks, in the device's folder.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "recording/store/disk/file_system.h"
#include "recording/store/stream/stream.h"

namespace imunoise::recording {

/// When a segment ends and the next begins: whichever comes first. What one sync() writes stays in
/// one segment.
struct SegmentLimits {
  std::uint64_t bytes = std::uint64_t{32} << 20U;
  std::chrono::nanoseconds time = std::chrono::minutes(10);  ///< By the blocks' host times.
};

/// Where a journal goes on.
struct JournalPlace {
  std::uint32_t replicate = 1;
  std::uint64_t segment = 1;   ///< Number of the next segment: none of this folder has it yet.
  std::uint64_t sequence = 1;  ///< Number of the next block.
};

/// Writes blocks; not thread-safe. A block is *acknowledged* when fdatasync of its segment has
/// returned (and, for the first block of a segment, fsync of the folder): from then on it survives
/// a power cut.
class Journal {
 public:
  /// The folder exists, and its own name is synced. Precondition: check_device() accepted.
  /// `first_share` of the limits, in (0, 1], ends the first segment, so that the segments of many
  /// devices do not all end at once.
  Journal(FileSystem& files, std::filesystem::path folder, v1::RecordedDevice device,
          const JournalPlace& place, const SegmentLimits& limits, double first_share = 1.0);

  /// Takes a block and numbers it; nothing is written yet. Precondition: check_block() accepted.
  std::uint64_t append(const Block& block);
  /// Writes what was appended and waits until it is safe. Error: the disk's; nothing is lost, the
  /// blocks stay here and the next sync() writes them into a new segment under the same numbers
  /// (so that a block whose fate is unknown is found once).
  Result<void> sync();

  /// The last block that is safe; 0 when there is none.
  std::uint64_t acknowledged() const { return acknowledged_; }
  /// True when some blocks wait for a sync() that succeeds.
  bool pending() const { return !pending_.empty(); }
  /// Ends the current segment.
  void end_segment();
  /// True when the disk did not let a segment go that holds nothing acknowledged.
  bool leftover() const { return !abandoned_.empty(); }
  /// Numbers of segments that grow no more, since the last call, in order.
  std::vector<std::uint64_t> take_ended() { return std::exchange(ended_, {}); }

 private:
  Result<void> write_pending();
  void abandon_segment();
  void remove_abandoned();

  FileSystem& files_;
  std::filesystem::path folder_;
  v1::RecordedDevice device_;
  JournalPlace place_;
  SegmentLimits limits_;
  double share_;  // of the limits that ends the current segment

  std::unique_ptr<WritableFile> file_;  // the current segment; null between two
  std::uint64_t bytes_ = 0;             // acknowledged, in the current segment
  std::int64_t begin_ns_ = 0;           // earliest and latest host time of the current segment
  std::int64_t end_ns_ = 0;
  bool timed_ = false;
  std::string pending_;  // frames not acknowledged
  std::uint64_t acknowledged_;
  std::vector<std::uint64_t> ended_;
  std::vector<std::uint64_t> abandoned_;  // segments without an acknowledged block
};

}  // namespace imunoise::recording
