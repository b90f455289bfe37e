#pragma once

// Which reader a file needs: its content decides, then its name.

#include <filesystem>

#include "core/support/result.h"

namespace imunoise::recording {

enum class Format { kHdf5, kNpy, kRaw, kText };

/// Error: unreadable, empty, a name that promises HDF5 or NumPy with other content, neither a known
/// name nor text.
Result<Format> detect_format(const std::filesystem::path& path);

}  // namespace imunoise::recording
