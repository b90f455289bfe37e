#pragma once

// The rows of a text table become columns of numbers.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/support/result.h"
#include "recording/import/text/text_layout.h"

namespace imunoise::recording {

/// Which line of the file each sample stands in. Costs memory only where comments or empty lines
/// come between rows.
class RowMap {
 public:
  /// Sample `sample` stands in `line`; called with rising samples.
  void add(std::size_t sample, std::size_t line) {
    if (runs_.empty() || line - sample != runs_.back().second) {
      runs_.emplace_back(sample, line - sample);
    }
  }
  /// The line, from 1, of a sample that was added.
  std::size_t line_of(std::size_t sample) const;

 private:
  std::vector<std::pair<std::size_t, std::size_t>> runs_;  // first sample, line minus sample
};

/// Parses rows and keeps the numbers of the wanted columns.
class RowParser {
 public:
  /// `wanted[c]` tells whether column c is kept.
  RowParser(std::string file, const TextLayout& layout, const std::vector<bool>& wanted);

  /// Makes room for `rows` rows in all, or an eighth more than there are if that is more. Does
  /// nothing while there is room for `spare` more rows.
  void reserve(std::size_t rows, std::size_t spare);
  /// Adds one row. Nothing when all is well; else what is wrong, with the row and the way out.
  std::optional<Error> add(std::string_view line, std::size_t line_number);

  std::size_t rows() const { return rows_; }
  const RowMap& row_map() const { return row_map_; }
  /// The numbers of column `column`, which was wanted.
  const std::vector<double>& values(std::size_t column) const { return values_[column]; }
  /// Takes them away.
  std::vector<double> take(std::size_t column) { return std::move(values_[column]); }

 private:
  bool parse_plain(std::string_view line);
  std::optional<Error> parse_with_care(std::string_view line, std::size_t line_number);

  std::string file_;
  const TextLayout& layout_;
  std::vector<bool> wanted_;
  std::vector<std::vector<double>> values_;  // one a column; empty where not wanted
  std::vector<double> row_;                  // the row under way
  std::size_t rows_ = 0;
  RowMap row_map_;
};

}  // namespace imunoise::recording
