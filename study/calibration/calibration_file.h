#pragma once

// calibration.json: what is known of a recording's noise, beside its manifest.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/support/result.h"
#include "imunoise/v1/calibration.pb.h"
#include "recording/store/disk/file_system.h"

namespace imunoise::study {

inline constexpr std::string_view kCalibrationName = "calibration.json";
inline constexpr std::uint32_t kCalibrationVersion = 1;

/// Error: not JSON, an unknown field, another version.
Result<v1::Calibration> parse_calibration(const std::string& text);

/// The calibration of the recording in `root`; nothing when there is none. Error: the disk's, or
/// what is wrong with the file.
Result<std::optional<v1::Calibration>> read_calibration(const recording::FileSystem& files,
                                                        const std::filesystem::path& root);

/// Replaces the calibration; after a power cut there is the old or the new one.
Result<void> write_calibration(recording::FileSystem& files, const std::filesystem::path& root,
                               const v1::Calibration& calibration);

}  // namespace imunoise::study
