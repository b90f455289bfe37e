#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>

#include "recording/import/hdf5/hdf5_reader.h"

namespace imunoise::recording {

#ifdef IMUNOISE_SANITIZED
inline constexpr bool kHdf5Apart = false;
#else
inline constexpr bool kHdf5Apart = true;
#endif

/// Reads a file of `bytes` bytes in a process of its own, with limits on memory and computing time:
/// HDF5 crashes on some damaged files, never ends on others, and believes any size that it finds.
/// A file that does such a thing is refused. `stopped` ends the reading within a tenth of a second.
/// Builds with sanitizers read it in this process: their allocators may hold a lock at a fork,
/// which the child then waits for without end. The C library's gives its locks up.
Result<std::unique_ptr<Hdf5Reader>> open_hdf5_apart(const std::filesystem::path& path,
                                                    std::uint64_t bytes,
                                                    std::function<bool()> stopped);

}  // namespace imunoise::recording
