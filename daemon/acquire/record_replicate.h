#pragma once

// One replicate of some devices, from opening them to a closed recording.

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/support/progress.h"
#include "drivers/host/device.h"
#include "recording/store/recorder.h"

namespace imunoise::acquire {

/// A device to record.
struct DevicePlan {
  std::string name;  ///< In the recording; unique there.
  drivers::Driver driver;
  std::vector<drivers::OptionText> options;
};

struct ReplicatePlan {
  std::filesystem::path folder;  ///< Of the recording; made when missing.
  std::uint32_t replicate = 1;
  std::vector<DevicePlan> devices;
  /// How long to record once all devices are open; unset: until every device has ended.
  std::optional<std::chrono::duration<double>> duration;
  /// Keeps what comes over each device's wire, where its driver tells, in "replicate-1/imu0.wire".
  bool wire = false;
};

/// What became of a device.
struct DeviceOutcome {
  v1::RecordedDevice device;
  std::vector<recording::StreamCounts> streams;  ///< received = stored + refused
  std::uint64_t disconnections = 0;
  std::optional<Error> failure;  ///< Why it was given up before the end; its samples are kept.
};

/// Told from any thread: which device, and what its driver says.
using DeviceNote = std::function<void(const std::string& device, std::string_view text)>;

/// Opens the devices, records them, each from a thread of its own, and closes the recording: at the
/// end of the plan's duration, when every device has ended or failed, or when the caller stops it,
/// which is no error. A device that is unplugged is waited for. Error: a device that does not open,
/// the disk's; samples that were acknowledged stay in the recording.
Result<std::vector<DeviceOutcome>> record_replicate(recording::FileSystem& files,
                                                    const ReplicatePlan& plan,
                                                    const DeviceNote& note = {},
                                                    const Progress& progress = {});

}  // namespace imunoise::acquire
