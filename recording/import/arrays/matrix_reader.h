#pragma once

// The matrices of a MATLAB file of version 5 to 7, one after the other. Source: MathWorks,
// "MAT-File Format" (R2022b), chapter 1.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"
#include "recording/import/arrays/array_table.h"
#include "recording/import/packed/byte_stream.h"

namespace imunoise::recording {

/// Bytes in which every MATLAB file of this kind begins, behind a text of 116 and 8 more bytes.
inline constexpr std::uint64_t kMatlabHeader = 128;

/// What to do with matrices of numbers: structs of one element are opened, and name their fields as
/// "imu.gyro"; everything else is passed over.
struct MatrixVisitor {
  /// A matrix with its place among all; whether its numbers are wanted.
  std::function<bool(const NamedArray& array, std::size_t index)> begin;
  std::function<void(std::size_t index, double number)> number;
  /// A matrix that is whole.
  std::function<void(std::size_t index)> end;
  /// What was passed over, a sentence each.
  std::function<void(std::string note)> note;
};

/// Walks through top-level elements; one walk a reader. `swap`: the file has the other byte order.
class MatrixReader {
 public:
  MatrixReader(const MatrixVisitor& visitor, bool swap) : visitor_(visitor), swap_(swap) {}

  /// The matrix whose content the stream holds from here on, `bytes` of it. False: it broke off.
  /// Error: the disk's, bytes that are no matrix.
  Result<bool> matrix(ByteStream& stream, std::uint64_t bytes);

 private:
  struct Tag {
    std::uint32_t type = 0;
    std::uint32_t bytes = 0;
    std::string small;  // content of a small element
    bool is_small = false;
  };
  struct Place;

  Result<bool> walk(Place& at, std::uint64_t bytes, const std::string& prefix, int depth);
  Result<bool> inside(Place& at, const std::string& prefix, int depth);
  Result<bool> numbers(Place& at, NamedArray array);
  Result<bool> fields(Place& at, const std::string& name, int depth);
  Result<bool> tag(Place& at, Tag& out) const;
  Result<bool> content(Place& at, const Tag& tag, std::uint64_t most, std::string& out) const;

  const MatrixVisitor& visitor_;
  bool swap_;
  std::size_t count_ = 0;
};

}  // namespace imunoise::recording
