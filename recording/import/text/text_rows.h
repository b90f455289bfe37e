#pragma once

// The rows of a text table become columns of numbers.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/support/result.h"
#include "recording/import/table/time_column.h"
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

/// Parses rows and keeps the numbers of the wanted columns. Values that are missing are NaN; so are
/// all values of a row that cannot be read.
class RowParser {
 public:
  /// `wanted[c]` tells whether column c is kept; `time` is the column of stamps.
  RowParser(std::string file, const TextLayout& layout, const std::vector<bool>& wanted,
            std::optional<std::size_t> time);

  /// Makes room for `rows` rows in all, or an eighth more than there are if that is more. Does
  /// nothing while there is room for `spare` more rows.
  void reserve(std::size_t rows, std::size_t spare);
  /// Adds one row. Nothing when all is well; else why the file as a whole cannot be read, with the
  /// row and the way out.
  std::optional<Error> add(std::string_view line, std::size_t line_number);

  /// Rows that could not be read, and what was wrong with the first.
  std::size_t unreadable() const { return unreadable_; }
  const std::string& first_unreadable() const { return first_unreadable_; }
  Stamps take_stamps() { return std::move(stamps_); }
  bool calendar() const { return calendar_; }

  std::size_t rows() const { return rows_; }
  const RowMap& row_map() const { return row_map_; }
  /// Takes the numbers of a wanted column away.
  std::vector<double> take(std::size_t column) { return std::move(values_[column]); }

 private:
  bool parse_plain(std::string_view line);
  std::optional<Error> parse_with_care(std::string_view line, std::size_t line_number);
  bool begins_another_table(const std::vector<std::string>& fields) const;
  // Nothing where only this row is left out.
  std::optional<Error> leave_out(const std::vector<std::string>& fields, std::size_t line_number,
                                 const std::string& what);
  const char* read_stamp(const char* begin, const char* end);
  bool read_stamp_with_care(std::string_view text);

  std::string file_;
  const TextLayout& layout_;
  std::vector<bool> wanted_;
  std::optional<std::size_t> time_;
  std::vector<std::vector<double>> values_;  // one a column; empty where not wanted
  std::vector<double> row_;                  // the row under way
  std::string pointed_;                      // its text, where numbers have decimal commas
  Stamps stamps_ = std::vector<std::int64_t>();
  std::int64_t whole_stamp_ = 0;  // of the row under way, while stamps are whole numbers
  double stamp_ = 0.0;            // afterwards
  bool calendar_ = false;
  std::int64_t last_of_day_ = 0;  // ns, of a time without a date
  std::int64_t midnights_ = 0;    // ns, of the days before
  std::size_t rows_ = 0;
  std::size_t unreadable_ = 0;
  std::string first_unreadable_;
  RowMap row_map_;
};

}  // namespace imunoise::recording
