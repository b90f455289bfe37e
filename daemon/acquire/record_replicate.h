#pragma once

// One replicate of some devices, from opening them to a closed recording.

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/support/progress.h"
#include "daemon/acquire/clock.h"
#include "daemon/acquire/disk_space.h"
#include "daemon/acquire/open_devices.h"
#include "daemon/acquire/reader.h"
#include "recording/store/recorder/recorder.h"

namespace imunoise::acquire {

struct ReplicatePlan;

/// Sees a replicate while it is recorded. take() comes from a thread a device, the others from one,
/// between begin() and end().
class ReplicateObserver {
 public:
  virtual ~ReplicateObserver() = default;
  virtual void begin(const ReplicatePlan& plan, const std::vector<v1::RecordedDevice>& devices) = 0;
  /// What the recorder knows, in order of the devices: may be asked from any thread until end().
  virtual void watch(std::function<recording::RecorderState()> /*recorder*/) {}
  /// The replicate's own thread goes on: at least once a second.
  virtual void beat() {}
  /// One more device, whose index is the next.
  virtual void join(const v1::RecordedDevice& device) = 0;
  /// `device` is an index in begin()'s, or of one that joined.
  virtual void take(std::size_t device, const recording::Block& block) = 0;
  virtual void end() = 0;
};

struct ReplicatePlan {
  std::filesystem::path folder;  ///< Of the recording; made when missing.
  std::uint32_t replicate = 1;
  std::string unfinished;  ///< Why the one before was not closed, where that is known.
  std::vector<DevicePlan> devices;
  /// How long to record once the devices are open; unset: until every device has ended.
  std::optional<std::chrono::duration<double>> duration;
  /// Keeps what comes over each device's wire, where its driver tells, in "replicate-1/imu0.wire".
  bool wire = false;
  std::string campaign;  ///< For the manifest.
  /// Set: a device that has not opened by then is missing, unless all are, and joins the others
  /// when it comes, if `reopening` is set. Unset: it is an error.
  std::optional<std::chrono::duration<double>> patience;
  /// Set: a device that fails is opened again. Unset: it is given up.
  std::optional<Reopening> reopening;
  /// Of the disk. With a duration, recording does not begin unless this replicate and
  /// `replicates_to_come` like it fit beside it; it ends when it is reached.
  std::uint64_t reserve_bytes = 0;
  std::uint32_t replicates_to_come = 0;
  const Clock* clock = &system_clock();
  recording::RecorderOptions recorder = {};
  std::chrono::milliseconds disk_patience{10000};  ///< As a reader's.
  ReplicateObserver* observer = nullptr;           ///< May be none; outlives the replicate.
};

/// What became of a device.
struct DeviceOutcome {
  v1::RecordedDevice device;
  std::vector<recording::StreamCounts> streams;  ///< received = stored + refused
  std::uint64_t disconnections = 0;
  std::optional<Error> failure;  ///< Why it was given up before the end; its samples are kept.
};

struct ReplicateOutcome {
  std::vector<DeviceOutcome> devices;  ///< Without those that never came.
  v1::ReplicateNote note;              ///< As the manifest has it.
};

/// The replicate is complete if every device that was there reached the planned end, and every row
/// that came and was not refused is stored; else it is interrupted, and the reason names the
/// device. While the disk fails or hangs, devices are read on: rows wait in memory, and those that
/// find no room there are counted.
///
/// Opens the devices, records them, each from a thread of its own, and closes the recording: at the
/// end of the plan's duration, when every device has ended or failed, when the disk's reserve is
/// reached, or when the caller stops it, which is no error. A device that is unplugged is waited
/// for. Error: a device that does not open, the disk's, no room; samples that were acknowledged
/// stay in the recording.
Result<ReplicateOutcome> record_replicate(recording::FileSystem& files, const ReplicatePlan& plan,
                                          const DeviceNote& note = {},
                                          const Progress& progress = {});

}  // namespace imunoise::acquire
