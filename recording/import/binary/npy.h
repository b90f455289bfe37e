#pragma once

// NumPy's .npy files: versions 1 to 3, one or two dimensions, rows are samples.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"
#include "recording/import/packed/byte_stream.h"
#include "recording/import/table/options.h"
#include "recording/import/table/table.h"

namespace imunoise::recording {

/// The first bytes of every .npy file.
inline constexpr std::string_view kNpyMagic = "\x93NUMPY";

/// What the header of a .npy file says.
struct NpyHeader {
  std::string dtype;  ///< e.g. "<f8"
  bool fortran_order = false;
  std::vector<std::uint64_t> shape;
};

/// The dictionary at the beginning of a .npy file, and where its numbers begin.
struct NpyPreamble {
  std::string dictionary;
  std::uint64_t end = 0;
};

/// Reads up to the first number. `name` is for messages. Error: it ends before, another version.
Result<NpyPreamble> read_npy_preamble(const std::string& name, ByteStream& from);

/// Parses the dictionary in a .npy header. Error: what is wrong, without the file's name.
Result<NpyHeader> parse_npy_header(std::string_view text);

/// Reads the wanted columns of a .npy file; its sidecar, if there is one, gives rate, names, units.
/// Errors: see import_files.
Result<Table> read_npy(const std::filesystem::path& path, const ImportOptions& options,
                       FileProgress& progress);

}  // namespace imunoise::recording
