#pragma once

// A file in memory with a path, for readers that want one.

#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>

#include "recording/import/table/channel.h"

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

/// Whatever is used of a channel is a finite number.
inline void require_finite(const Channel& channel) {
  if (const auto* values = std::get_if<std::vector<double>>(channel.samples.get())) {
    for (std::size_t i = 0; i < channel.count; ++i) {
      if (!std::isfinite(values->at(channel.begin + i))) std::abort();
    }
  }
}

}  // namespace imunoise::recording
