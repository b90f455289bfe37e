#pragma once

// What the host does for plugins.

#include "drivers/driver.h"

namespace imunoise::drivers {

/// The table that every plugin is given. The context of a note is a NoteHandler. Lives for ever.
const imunoise_host& host_services();

}  // namespace imunoise::drivers
