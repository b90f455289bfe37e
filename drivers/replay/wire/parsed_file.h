#pragma once

#include <array>
#include <filesystem>
#include <fstream>

#include "drivers/codec/bytes.h"
#include "drivers/plugin/device.h"

namespace imunoise::replay {

/// What a codec's parser finds in a file, one after another; the file is read piece by piece, so
/// that captures may be of any length. Parser: push(), finish() and next(), as drivers::XbusParser
/// has them.
template <class Parser>
class ParsedFile {
 public:
  /// Throws plugin::DeviceError: NOT_FOUND.
  explicit ParsedFile(const std::filesystem::path& path) : file_(path, std::ios::binary) {
    if (!file_ || std::filesystem::is_directory(path)) {
      throw plugin::DeviceError(
          IMUNOISE_NOT_FOUND,
          path.string() + ": cannot be read; check the path and its permissions");
    }
  }

  /// The next of them, good until the next call; none at the end.
  auto next() {
    for (;;) {
      if (auto found = parser_.next(); found || ended_) return found;
      feed();
    }
  }
  const Parser& parser() const { return parser_; }

 private:
  void feed() {
    file_.read(static_cast<char*>(static_cast<void*>(buffer_.data())),
               static_cast<std::streamsize>(buffer_.size()));
    const drivers::Bytes bytes =
        drivers::Bytes(buffer_).first(static_cast<std::size_t>(file_.gcount()));
    ended_ = bytes.empty();
    if (ended_) {
      parser_.finish();
    } else {
      parser_.push(bytes);
    }
  }

  std::ifstream file_;
  std::array<std::uint8_t, 65'536> buffer_{};
  Parser parser_;
  bool ended_ = false;
};

}  // namespace imunoise::replay
