#pragma once

// What the first lines of a text table tell: delimiter, names, units.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "recording/import/table/options.h"
#include "recording/import/text/fields.h"

namespace imunoise::recording {

/// The first rows of a text file, comments and empty lines left out. UTF-8.
struct TextHead {
  struct Row {
    std::size_t line = 0;  ///< Number in the file, from 1.
    std::string text;
  };
  std::string file;          ///< For messages.
  std::vector<Row> rows;     ///< Up to kHeadRows, or kPreambleRows where those differ in shape.
  std::string last_comment;  ///< The last comment before the first row, without '#'.
};

/// A header, a row of units, two rows of numbers.
inline constexpr std::size_t kHeadRows = 4;
/// A logger may write what it knows of itself before the table: fewer rows than this.
inline constexpr std::size_t kPreambleRows = 100;

/// How the rows of the file are to be read.
struct TextLayout {
  char delimiter = ',';              ///< ' ' for runs of blanks.
  bool decimal_comma = false;        ///< Numbers are written "1,5".
  std::vector<HeaderField> columns;  ///< One a column; without a header col1, col2, ...
  std::vector<bool> unnamed;    ///< Columns whose header is empty: an index, a trailing delimiter.
  std::size_t header_rows = 0;  ///< How many of the head's rows hold no samples.
  std::vector<std::string> notes;  ///< What was left out or renamed, a sentence each.
};

/// Whether one delimiter cuts all rows into the same number of fields, two or more.
bool have_one_shape(const std::vector<TextHead::Row>& rows);

/// Whether no row has more numbers than words: the table begins later, or holds few numbers.
bool hold_few_numbers(const std::vector<TextHead::Row>& rows);

/// Error: no rows; a first row of which one cannot tell whether it is a header; a row of units with
/// an unknown one or of the wrong length.
Result<TextLayout> detect_layout(const TextHead& head, const ImportOptions& options);

}  // namespace imunoise::recording
