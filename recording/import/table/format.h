#pragma once

// What a format of files is. Its content decides which format a file has, then its name.

#include <filesystem>
#include <string_view>

#include "core/support/result.h"
#include "recording/import/table/file.h"
#include "recording/import/table/options.h"
#include "recording/import/table/table.h"

namespace imunoise::recording {

/// A file whose format is sought.
struct UnknownFile {
  const File& content;
  std::string_view head;  ///< Its first bytes, up to 4096.
  std::filesystem::path extension;
};

/// One format. Each is a function in the source of its reader, and a line in format.cpp.
struct ImportFormat {
  std::string_view kind;  ///< For messages: "HDF5 (.h5)".
  /// Whether the first bytes say so beyond doubt, whatever the name says; null: they never do.
  bool (*begins)(std::string_view head) = nullptr;
  /// Whether a file that no format's first bytes claim is of this one. Asked in the order of the
  /// list. Error: the name says so and the content does not.
  Result<bool> (*claims)(const UnknownFile& file) = nullptr;
  /// Reads the wanted channels. Errors: see import_files.
  Result<Table> (*read)(const std::filesystem::path& path, const ImportOptions& options,
                        FileProgress& progress) = nullptr;
};

/// The format of a file. Error: unreadable, empty, a name that promises another content, no known
/// format.
Result<const ImportFormat*> detect_format(const std::filesystem::path& path);

}  // namespace imunoise::recording
