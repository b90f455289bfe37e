#pragma once

// Lines of a text file of any length, read in blocks of fixed size.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "recording/import/table/file.h"

namespace imunoise::recording {

/// Bytes of text held at a time.
inline constexpr std::size_t kBlockBytes = std::size_t{1} << 20U;

/// Hands out one line after the other. Memory: one block, or the longest line (at most 1 MiB).
class LineReader {
 public:
  /// `block_bytes` (at least 1) is a parameter so that tests can put block borders anywhere.
  LineReader(const File& file, std::size_t block_bytes);

  /// The next line without its ending (LF, CRLF or CR) and without the byte order mark of UTF-8;
  /// valid until the next call. Nothing at the end of the file or after an error: ask error().
  std::optional<std::string_view> next();

  /// Number of the line that next() gave last, 1 for the first.
  std::size_t line_number() const { return line_number_; }
  /// Bytes handed out so far.
  std::uint64_t bytes_done() const { return loaded_ - (end_ - begin_); }
  /// What stopped next() early: the disk, a line that is too long, text in UTF-16.
  const std::optional<Error>& error() const { return error_; }

 private:
  bool load_more();

  const File& file_;
  std::size_t block_bytes_;
  std::vector<char> buffer_;  // [begin_, end_) is text not handed out yet
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::uint64_t loaded_ = 0;
  char ending_;
  std::size_t line_number_ = 0;
  std::optional<Error> error_;
};

}  // namespace imunoise::recording
