#pragma once

// What the host does for plugins.

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>

#include "drivers/driver.h"
#include "drivers/host/handlers.h"

namespace imunoise::drivers {

/// What is done with what a driver tells of a device, and asks for; any may be empty.
struct DeviceHandlers {
  NoteHandler note = {};
  WireHandler wire = {};
  std::stop_token stop = {};  ///< Of its opening.
  /// What the driver wants called then.
  std::optional<std::stop_callback<std::function<void()>>> stopping = {};
};

/// The host's clock for time stamps, ns since 1970-01-01 UTC: the time of day when this process
/// asked first, continued by the time since the machine started (CLOCK_BOOTTIME). It never steps
/// when the time of day is set; the difference between the two shows that it was set.
std::int64_t host_time_ns();

/// The table that every plugin is given. The context of its functions is a DeviceHandlers. Lives
/// for ever.
const imunoise_host& host_services();

}  // namespace imunoise::drivers
