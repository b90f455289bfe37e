#pragma once

// Reads recordings that others made: HDF5, CSV and its kin, NumPy, raw numbers with a sidecar.

#include <filesystem>
#include <span>
#include <vector>

#include "core/support/progress.h"
#include "core/support/result.h"
#include "recording/import/table/channel.h"
#include "recording/import/table/options.h"

namespace imunoise::recording {

/// Reads the files in the order given; each stretch without a fault (see preflight.h) is a
/// replicate, or `split_into` of them. The format is told by content first, then by extension.
/// Files are read in parallel; the result does not depend on it. Each replicate carries its file's
/// preflight.
///
/// Replicates of several files hold the same channels in the same units, and one rate: rates that
/// files state may differ by 0.1 % (clocks do), all replicates then carry the first file's.
///
/// Errors name the file, the row (line of a text file, sample otherwise) and the way out: an
/// unknown unit, a missing channel, a truncated file, fewer than kMinimumSamples in a replicate,
/// files that disagree, a stop request. Never throws. Thread-safe.
Result<std::vector<Replicate>> import_files(std::span<const std::filesystem::path> paths,
                                            const ImportOptions& options = {},
                                            const Progress& progress = {});

}  // namespace imunoise::recording
