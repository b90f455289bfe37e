#pragma once

// From the files of recordings to what the catalogue keeps of them.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "imunoise/v1/calibration.pb.h"
#include "imunoise/v1/recording.pb.h"
#include "recording/store/disk/file_system.h"

namespace imunoise::catalogue {

/// Paths of all recordings under a root, inside it, with '/', sorted; "." where the root is one
/// itself. Links are not followed, names that begin with a dot are passed over, and nothing is
/// sought inside a recording. Error: the root cannot be listed.
Result<std::vector<std::string>> find_recordings(const recording::FileSystem& files,
                                                 const std::filesystem::path& root);

/// What the files of a recording say. What cannot be read is told in a trouble.
struct Found {
  std::string folder;
  std::string stamp;  ///< another one: the files say something else
  v1::Manifest manifest;
  std::string trouble;  ///< of the manifest
  std::optional<v1::Calibration> calibration;
  std::string calibration_trouble;
};

/// The stamp of a recording's files, without understanding them.
std::string stamp_of(const recording::FileSystem& files, const std::filesystem::path& recording);

Found read_found(const recording::FileSystem& files, const std::filesystem::path& root,
                 const std::string& folder);

/// How a device is known over months: "adis16405:0042", or its name where it has no serial number.
std::string device_id(const v1::RecordedDevice& device);

}  // namespace imunoise::catalogue
