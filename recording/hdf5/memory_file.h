#pragma once

// HDF5 files in memory: the library never touches the disk, so that whoever does can decide when
// bytes are safe, and read each file once for its checksum and its contents.

#include <optional>
#include <string>
#include <string_view>

#include "recording/hdf5/handle.h"

namespace imunoise::recording {

/// An empty file in memory, of format bounds V110: its metadata carries checksums.
Hdf5Handle create_memory_file();
/// The bytes that the file would have on disk; nothing when HDF5 refuses.
std::optional<std::string> file_image(hid_t file);
/// Opens the bytes of a file for reading; an invalid handle when they are none. Copies the bytes.
Hdf5Handle open_memory_file(std::string_view bytes);

}  // namespace imunoise::recording
