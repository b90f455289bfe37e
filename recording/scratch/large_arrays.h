#pragma once

// Memory for arrays that are larger than memory should hold.

#include <cstddef>
#include <filesystem>

namespace imunoise::recording {

/// A vector or matrix of so many bytes is large.
inline constexpr std::size_t kLargeArray = std::size_t{512} << 10U;

/// How a program keeps its large arrays.
struct LargeArrays {
  /// Of the file: on a disk. Empty: there is no file.
  std::filesystem::path folder;
  /// Bytes of large arrays that lie in ordinary memory; those that come after lie in the file.
  std::size_t in_memory = std::size_t{512} << 20U;
  /// Bytes of mapped files (the program itself included) that may stay in the process's memory.
  /// What exceeds them leaves it within some ms, and comes back when it is used.
  std::size_t mapped = std::size_t{512} << 20U;
};

/// From now on, what `new` and `malloc` in this program give for large arrays lies in an unnamed
/// file beyond `in_memory` bytes. The file is made when it is first needed, and is gone with the
/// process; where the disk has no room, arrays stay in memory. A process that is forked off uses
/// memory alone. To be called once, before there are threads. A program that links this room has
/// its malloc, calloc, realloc, free, new and delete replaced; builds with sanitizers have none
/// of it.
void keep_large_arrays(const LargeArrays& how);

}  // namespace imunoise::recording
