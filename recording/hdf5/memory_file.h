#pragma once

// HDF5 files in memory: the library never touches the disk, so that its caller can decide when
// bytes are safe, and read each file once for its checksum and its contents.

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "recording/hdf5/handle.h"

namespace imunoise::recording {

/// A new file, of format bounds V110: its metadata carries checksums.
class NewMemoryFile {
 public:
  NewMemoryFile();
  ~NewMemoryFile();
  NewMemoryFile(const NewMemoryFile&) = delete;
  NewMemoryFile& operator=(const NewMemoryFile&) = delete;

  /// The file; negative when HDF5 refused.
  hid_t id() const { return file_.get(); }
  /// Closes it: the bytes that a file on disk would have. Nothing when HDF5 refuses; everything
  /// else of the file must be closed before.
  std::optional<std::string> finish();

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
  Hdf5Handle file_;
};

/// Opens the bytes of a file for reading; an invalid handle when they are none. Copies the bytes.
Hdf5Handle open_memory_file(std::string_view bytes);

}  // namespace imunoise::recording
