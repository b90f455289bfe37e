#pragma once

#include <array>
#include <filesystem>
#include <fstream>

#include "drivers/codec/bytes.h"
#include "drivers/plugin/device.h"

namespace imunoise::replay {

/// A file piece by piece, so that captures may be of any length.
class ByteFile {
 public:
  /// Throws plugin::DeviceError: NOT_FOUND.
  explicit ByteFile(const std::filesystem::path& path) : file_(path, std::ios::binary) {
    if (!file_ || std::filesystem::is_directory(path)) {
      throw plugin::DeviceError(IMUNOISE_NOT_FOUND,
                                path.string() + ": cannot be read; is it there?");
    }
  }

  /// The next bytes; none at the end. Good until the next call.
  drivers::Bytes read() {
    file_.read(static_cast<char*>(static_cast<void*>(buffer_.data())),
               static_cast<std::streamsize>(buffer_.size()));
    return drivers::Bytes(buffer_).first(static_cast<std::size_t>(file_.gcount()));
  }

 private:
  std::ifstream file_;
  std::array<std::uint8_t, 65'536> buffer_{};
};

}  // namespace imunoise::replay
