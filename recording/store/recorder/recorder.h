#pragma once

// Records one replicate of some devices: the readers of devices hand blocks over, two threads of
// the recorder write them: one the journals, one the chunks.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "recording/store/disk/watched_files.h"
#include "recording/store/journal/journal.h"
#include "recording/store/manifest/manifest.h"

namespace imunoise::recording {

/// What is recorded.
struct RecordingPlan {
  std::string campaign;
  std::uint32_t replicate = 1;
  std::int64_t started_ns = 0;  ///< ns since 1970-01-01 UTC, for the manifest.
  std::vector<v1::RecordedDevice> devices;
  /// Set: how the replicate comes about, for the manifest; its number, start and state are filled
  /// in.
  std::optional<v1::ReplicateNote> note = {};
  std::string unfinished = {};  ///< Why the replicate before was not closed, where that is known.
};

struct RecorderOptions {
  SegmentLimits segments;
  std::uint64_t waiting_rows = 1U << 18U;  ///< A device's rows that may wait for the journal.
  /// How long a block may wait for its fdatasync, unless the queue fills: all that a power cut
  /// costs.
  std::chrono::nanoseconds sync_every = std::chrono::milliseconds(500);
};

/// Rows of one stream so far. After close(), received = stored + refused, whatever happened.
struct StreamCounts {
  std::uint64_t received = 0;  ///< Delivered by the device.
  std::uint64_t stored = 0;    ///< Acknowledged: safe in the journal or in a chunk.
  std::vector<Refusal> refused;
};

/// A disk that fails, from its first error on until a call of the same kind succeeds.
struct DiskTrouble {
  Error error;                                  ///< The last one.
  std::chrono::steady_clock::time_point since;  ///< Of the first one.
  std::int64_t since_ns = 0;                    ///< The same, ns since 1970-01-01 UTC.
};

/// The disk under one device.
struct DeviceDisk {
  std::optional<DiskTrouble>
      trouble;  ///< Samples wait in memory; or, if not, chunks cannot be made.
  /// The oldest call in the device's folder that has not returned. When it is seconds old, the disk
  /// hangs.
  std::optional<DiskCall> call;
};

struct RecorderState {
  std::vector<std::vector<StreamCounts>> counts;  ///< Of each device's streams.
  std::vector<std::uint64_t> acknowledged;        ///< Of each device: its last block that is safe.
  std::vector<DeviceDisk> disks;                  ///< Of each device.
  std::vector<DiskCall> calls;  ///< All calls that have not returned, the oldest first.
};

/// The note of a replicate, made when it is known what became of every row.
using Conclusion = std::function<v1::ReplicateNote(const RecorderState&)>;

/// Functions are thread-safe, except that close() comes after all others; the blocks of one device
/// come from one thread.
class Recorder {
 public:
  /// Locks the folder (made when missing), recovers what an interrupted recording left, writes the
  /// manifest. Replicates that were closed are not read again. Error: the disk's (nothing is set
  /// aside because it cannot be read; try again), another process records into it, a plan that
  /// cannot be, a device whose replicate is recorded already.
  static Result<std::unique_ptr<Recorder>> start(FileSystem& files,
                                                 const std::filesystem::path& folder,
                                                 const RecordingPlan& plan,
                                                 const RecorderOptions& options = {});
  /// Closes, its outcome unheard.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// What start() found in the folder and did, for people: what a crash left, what was damaged and
  /// set aside, what is missing.
  const std::vector<std::string>& repaired() const;

  /// Hands a block over and never waits. False when too many rows wait already: the block's rows
  /// are then refused (overrun), and the next row of the stream carries kLostBefore. Error: a block
  /// that does not fit its description.
  Result<bool> offer(std::size_t device, Block block);
  /// Hands a block over, waiting for room. Error: as offer(), or that of the disk under this
  /// device; the block is then not taken and may be pushed again.
  Result<void> push(std::size_t device, const Block& block);
  /// As push(), but waits no longer than `patience`, whatever the disk does; false: there was no
  /// room, and the block is not taken.
  Result<bool> push_for(std::size_t device, const Block& block, std::chrono::milliseconds patience);

  RecorderState state() const;

  /// What the manifest says of the replicate from its next writing on: by add() or close(). Not
  /// while one of these runs.
  void annotate(const v1::ReplicateNote& note);

  /// Records one more device from now on; its number for offer() and push(). The manifest is
  /// written. One thread at a time. Error: as start()'s of a device, or the disk's; the others are
  /// recorded on.
  Result<std::size_t> add(const v1::RecordedDevice& device);

  /// Writes everything out, makes the last chunks, closes the manifest. Rows that no disk took are
  /// not_written in the state that follows and in the manifest (should a failing disk hold them
  /// after all, a recovery finds them, once). Then `conclude`, if there is one, makes the
  /// replicate's note; its counts are filled in, and when rows were not written the replicate is
  /// interrupted, whatever the note says. Error: rows of a device were not written, a chunk or the
  /// manifest could not be; what was acknowledged stays in the journals, for the next recording
  /// into the folder or `imunoise verify --repair`.
  Result<void> close(const Conclusion& conclude = {});

  /// After close(): the replicate's note as the manifest has it; nothing when the plan had none.
  std::optional<v1::ReplicateNote> note() const;

 private:
  class Threads;
  explicit Recorder(std::unique_ptr<Threads> threads);
  std::unique_ptr<Threads> threads_;
};

}  // namespace imunoise::recording
