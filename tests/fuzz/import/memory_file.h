#pragma once

// Bytes as a file with a path, for readers that want one, and any bytes as an import.

#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <variant>

#include "recording/import/import.h"

namespace imunoise::recording {

class MemoryFile {
 public:
  explicit MemoryFile(std::string_view bytes) : descriptor_(::memfd_create("fuzz", MFD_CLOEXEC)) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written <= 0) std::abort();
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
  }
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

/// A file with a name of its own, for libraries that follow links (SQLite).
class NamedFile {
 public:
  explicit NamedFile(std::string_view bytes) {
    std::ofstream(path(), std::ios::binary | std::ios::trunc) << bytes;
  }
  ~NamedFile() { ::unlink(path().c_str()); }
  NamedFile(const NamedFile&) = delete;
  NamedFile& operator=(const NamedFile&) = delete;

  static std::filesystem::path path() {
    return "/dev/shm/imunoise-fuzz-" + std::to_string(::getpid());
  }
};

/// Whatever is used of a channel is a finite number.
inline void require_finite(const Channel& channel) {
  if (const auto* values = std::get_if<std::vector<double>>(channel.samples.get())) {
    for (std::size_t i = 0; i < channel.count; ++i) {
      if (!std::isfinite(values->at(channel.begin + i))) std::abort();
    }
  }
}

/// Imports a file with and without a stated rate: no crash, no number that is not finite.
inline void require_sound_import(const std::filesystem::path& path,
                                 const ImportOptions& also = {}) {
  for (const bool stated : {false, true}) {
    ImportOptions options = also;
    if (stated) options.rate = Hertz{100.0};
    const std::filesystem::path paths[] = {path};
    const auto got = import_files(paths, options);
    if (!got) continue;
    for (const Replicate& one : *got) {
      for (const Channel& channel : one.channels) require_finite(channel);
    }
  }
}

/// The fuzzer's bytes.
inline std::string_view bytes_at(const std::uint8_t* data, std::size_t size) {
  return {static_cast<const char*>(static_cast<const void*>(data)), size};
}

/// The fuzzer's bytes behind the first ones of a format.
inline int import_behind(std::string_view begin, const std::uint8_t* data, std::size_t size) {
  const MemoryFile file(std::string(begin).append(bytes_at(data, size)));
  require_sound_import(file.path());
  return 0;
}

}  // namespace imunoise::recording
