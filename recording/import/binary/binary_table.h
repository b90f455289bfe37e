#pragma once

// A table of bare little-endian numbers inside a file: what .npy and raw files have in common.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "imunoise/v1/sidecar.pb.h"
#include "recording/import/table/file.h"
#include "recording/import/table/options.h"
#include "recording/import/table/table.h"

namespace imunoise::recording {

enum class NumberType { kInt16, kInt32, kFloat32, kFloat64 };

/// Bytes of one number.
std::size_t width(NumberType type);

/// The type that NumPy calls "<i2", "<i4", "<f4" or "<f8"; nothing for any other.
std::optional<NumberType> number_type(std::string_view dtype);

/// Where the numbers are. Sample r of column c is number r · columns + c, or c · rows + r when
/// column_major.
struct BinaryLayout {
  NumberType type = NumberType::kFloat64;
  std::uint64_t begin = 0;  ///< First byte.
  std::size_t rows = 0;
  std::size_t columns = 1;
  bool column_major = false;
};

/// Reads the wanted columns, named and scaled as the sidecar says (col1, col2, ... without one).
/// The layout must fit the file's size: the caller has checked that. Errors: see import_files.
Result<Table> read_binary_table(const File& file, const BinaryLayout& layout,
                                const std::optional<v1::Sidecar>& sidecar,
                                const ImportOptions& options, FileProgress& progress);

}  // namespace imunoise::recording
