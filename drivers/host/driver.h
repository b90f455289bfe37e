#pragma once

// A driver that was loaded.

#include <filesystem>

#include "drivers/description.h"

namespace imunoise::drivers {

/// Copies are as good as the original: its code stays loaded until the program ends.
struct Driver {
  DriverInfo info;
  std::filesystem::path file;
  const imunoise_driver* table = nullptr;  ///< Checked by check_driver().
};

}  // namespace imunoise::drivers
