#pragma once

// Raw little-endian numbers, channels interleaved sample by sample, described by a sidecar.

#include <filesystem>

#include "recording/import/table/options.h"
#include "recording/import/table/table.h"

namespace imunoise::recording {

/// Reads the wanted channels of a raw file. Errors: no sidecar, no dtype or one that contradicts
/// the extension, a size that is not a whole number of rows; see import_files for the others.
Result<Table> read_raw(const std::filesystem::path& path, const ImportOptions& options,
                       FileProgress& progress);

}  // namespace imunoise::recording
