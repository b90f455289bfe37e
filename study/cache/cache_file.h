#pragma once

// Arrays of doubles in a file, to be mapped into memory: nothing is copied, nothing is parsed but
// the header.

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"
#include "core/support/shared_vector.h"
#include "imunoise/v1/cache.pb.h"

namespace imunoise::study {

struct CacheFile {
  v1::CacheHeader header;
  std::vector<SharedVector> arrays;
};

/// Replaces the file; after a power cut there may be none, or a damaged one, which reading tells.
/// The header's `arrays` are filled in. Error: the disk's.
Result<void> write_cache_file(const std::filesystem::path& path, CacheFile file);

/// Error: no such file, of another version or machine, or damaged.
Result<CacheFile> read_cache_file(const std::filesystem::path& path);

/// The same of a file's bytes, which `owner` keeps where they are: at a multiple of 64.
Result<CacheFile> parse_cache_file(std::string_view bytes, std::shared_ptr<const void> owner);

/// What a file with this header begins with: arrays follow, each from a multiple of 64 on.
std::string seen_front(const v1::CacheHeader& header);

}  // namespace imunoise::study
