#pragma once

// What the host does for plugins.

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

/// The table that every plugin is given. The context of its functions is a DeviceHandlers. Lives
/// for ever.
const imunoise_host& host_services();

}  // namespace imunoise::drivers
