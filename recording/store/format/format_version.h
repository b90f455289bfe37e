#pragma once

#include <cstdint>
#include <string>

namespace imunoise::recording {

/// Version of journals and chunks: written into each, and required on reading.
inline constexpr std::uint32_t kFormatVersion = 1;
/// Version of manifests. Those of version 1 are read too: they had everything in one file.
inline constexpr std::uint32_t kManifestVersion = 2;

/// Of a file whose version this program does not read; `newest` is the newest that it reads.
inline std::string other_version(std::uint64_t found, std::uint32_t newest = kFormatVersion) {
  const std::string what = "is of version " + std::to_string(found) + " of the format, ";
  if (found <= newest) return what + "which this program does not read";
  return what + "and this program reads versions up to " + std::to_string(newest) +
         ": a newer imunoise wrote it; use that one, or a later one";
}

}  // namespace imunoise::recording
