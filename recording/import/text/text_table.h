#pragma once

// CSV, TSV, semicolons, blanks: text tables of any length.

#include <filesystem>

#include "recording/import/table/options.h"
#include "recording/import/table/table.h"
#include "recording/import/text/line_reader.h"

namespace imunoise::recording {

/// Reads the wanted columns. Holds one block of text and the numbers, never the text as a whole.
/// A comment `# rate_hz: 100` before the first row states the rate when no time column does.
/// Errors: see import_files. `block_bytes` changes nothing but memory and speed.
Result<Table> read_text_table(const std::filesystem::path& path, const ImportOptions& options,
                              FileProgress& progress, std::size_t block_bytes = kBlockBytes);

}  // namespace imunoise::recording
