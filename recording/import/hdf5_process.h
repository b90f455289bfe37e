#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>

#include "recording/import/hdf5_reader.h"

namespace imunoise::recording {

/// Reads a file of `bytes` bytes in a process of its own, with limits on memory and computing time:
/// HDF5 crashes on some damaged files, never ends on others, and believes any size that it finds.
/// A file that does such a thing is refused. `stopped` ends the reading within a tenth of a second.
Result<std::unique_ptr<Hdf5Reader>> open_hdf5_apart(const std::filesystem::path& path,
                                                    std::uint64_t bytes,
                                                    std::function<bool()> stopped);

}  // namespace imunoise::recording
