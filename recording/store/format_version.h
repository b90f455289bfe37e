#pragma once

#include <cstdint>
#include <string>

namespace imunoise::recording {

/// Version of journals, chunks and manifests: written into each, and required on reading.
inline constexpr std::uint32_t kFormatVersion = 1;

inline std::string other_version(std::uint64_t found) {
  return "is of version " + std::to_string(found) + " of the format, this program reads version " +
         std::to_string(kFormatVersion) +
         "; use the version of imunoise that wrote it, or a later one";
}

}  // namespace imunoise::recording
