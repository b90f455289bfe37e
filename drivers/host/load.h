#pragma once

// Finds drivers.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"
#include "drivers/host/driver.h"

namespace imunoise::drivers {

/// A file that might have been a driver.
struct RefusedPlugin {
  std::filesystem::path file;
  std::string reason;
};

/// What was found where.
struct Drivers {
  std::vector<std::filesystem::path> folders;  ///< Searched, in this order.
  std::vector<Driver> found;                   ///< In the order found; names are unique.
  std::vector<RefusedPlugin> refused;

  /// Error: no such driver; names those there are, and why a file of that name was refused.
  Result<const Driver*> find(std::string_view name) const;
};

/// Where drivers are searched: `first`, then the folders of the environment variable
/// IMUNOISE_DRIVER_PATH (separated by ':'), then lib/imunoise/drivers of the installation or of the
/// build tree that the program lies in. Each once.
std::vector<std::filesystem::path> driver_folders(
    std::span<const std::filesystem::path> first = {});

/// Loads every imunoise-*.so of the folders, in order of folders and names; the first of a name
/// wins. What is not a driver is rejected, with the reason, and affects no other: no entry symbol,
/// another ABI, a table that check_driver() refuses, a name that is taken, or whatever dlopen says.
/// Folders that do not exist are passed over. Nothing is ever unloaded. Thread-safe.
Drivers load_drivers(std::vector<std::filesystem::path> folders);

}  // namespace imunoise::drivers
