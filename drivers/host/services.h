#pragma once

// What the host does for plugins.

#include "drivers/driver.h"
#include "drivers/host/handlers.h"

namespace imunoise::drivers {

/// What is done with what a driver tells of a device; either may be empty.
struct DeviceHandlers {
  NoteHandler note;
  WireHandler wire;
};

/// The table that every plugin is given. The context of note and wire is a DeviceHandlers. Lives
/// for ever.
const imunoise_host& host_services();

}  // namespace imunoise::drivers
