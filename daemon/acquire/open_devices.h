#pragma once

// Opens the devices of a replicate.

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/support/progress.h"
#include "drivers/host/device.h"
#include "imunoise/v1/recording.pb.h"

namespace imunoise::acquire {

/// A device to record.
struct DevicePlan {
  std::string name;  ///< In the recording; unique there.
  drivers::Driver driver;
  std::vector<drivers::OptionText> options;
};

/// Told from any thread: which device, and what its driver says.
using DeviceNote = std::function<void(const std::string& device, std::string_view text)>;

/// Opens one device. Error: names it.
Result<std::unique_ptr<drivers::Device>> open_device(const DevicePlan& plan, const DeviceNote& note,
                                                     drivers::WireHandler wire,
                                                     std::stop_token stop);

struct OpenDevices {
  std::vector<std::unique_ptr<drivers::Device>> devices;  ///< As the plans; null: missing.
  std::vector<v1::MissingDevice> missing;
};

/// The message of open_devices() where the caller stopped it: nothing was recorded yet.
inline constexpr const char* kStoppedOpening = "stopped while devices were being opened";

/// Opens all, `open(i)` the i-th. With patience: those that do not open are tried again for so
/// long, then they are missing. Error: one does not open and there is no patience, or none does, or
/// the caller stopped it.
Result<OpenDevices> open_devices(
    const std::vector<DevicePlan>& plans,
    const std::function<Result<std::unique_ptr<drivers::Device>>(std::size_t)>& open,
    std::optional<std::chrono::duration<double>> patience, const Progress& progress);

}  // namespace imunoise::acquire
