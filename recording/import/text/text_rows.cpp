#include "recording/import/text/text_rows.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstring>

#include "recording/import/text/number.h"

namespace imunoise::recording {

std::size_t RowMap::line_of(std::size_t sample) const {
  const auto after = std::upper_bound(runs_.begin(), runs_.end(), sample,
                                      [](std::size_t s, const auto& run) { return s < run.first; });
  return sample + std::prev(after)->second;
}

RowParser::RowParser(std::string file, const TextLayout& layout, const std::vector<bool>& wanted)
    : file_(std::move(file)),
      layout_(layout),
      wanted_(wanted),
      values_(layout.columns.size()),
      row_(layout.columns.size()) {}

void RowParser::reserve(std::size_t rows, std::size_t spare) {
  for (std::size_t c = 0; c < values_.size(); ++c) {
    if (!wanted_[c] || values_[c].capacity() - rows_ >= spare) continue;
    values_[c].reserve(std::max(rows, rows_ + rows_ / 8));
  }
}

std::optional<Error> RowParser::add(std::string_view line, std::size_t line_number) {
  if (!parse_plain(line)) {
    if (std::optional<Error> error = parse_with_care(line, line_number)) return error;
  }
  for (std::size_t c = 0; c < values_.size(); ++c) {
    if (wanted_[c]) values_[c].push_back(row_[c]);
  }
  row_map_.add(rows_++, line_number);
  return std::nullopt;
}

// The row as nearly all are: unquoted numbers. False sends the row to parse_with_care().
bool RowParser::parse_plain(std::string_view line) {
  const char delimiter = layout_.delimiter;
  const bool blanks = delimiter == ' ';
  const auto is_blank = [&](char c) { return c == ' ' || (c == '\t' && delimiter != '\t'); };
  const char* at = line.data();
  const char* const end = at + line.size();
  const std::size_t columns = row_.size();
  for (std::size_t c = 0; c < columns; ++c) {
    while (at != end && is_blank(*at)) ++at;
    if (wanted_[c]) {
      at = read_number(at, end, row_[c]);
      if (at == nullptr) return false;
    } else {
      while (at != end && *at != '"' && *at != delimiter && !(blanks && is_blank(*at))) ++at;
    }
    const char* const stop = at;
    while (at != end && is_blank(*at)) ++at;
    if (c + 1 == columns) break;
    if (blanks ? at == stop : (at == end || *at != delimiter)) return false;
    if (!blanks) ++at;
  }
  return at == end;
}

// Quoted numbers, and every kind of trouble.
std::optional<Error> RowParser::parse_with_care(std::string_view line, std::size_t line_number) {
  const std::vector<std::string> fields = split_fields(line, layout_.delimiter);
  const auto trouble = [&](const std::string& what) {
    return Error{fmt::format("{}: row {}: {}", file_, line_number, what)};
  };
  if (fields.size() != row_.size()) {
    return trouble(
        fmt::format("{} values where the table has {} columns; delete the row or split the "
                    "file there (columns are separated by {})",
                    fields.size(), row_.size(),
                    layout_.delimiter == ' '    ? std::string("blanks")
                    : layout_.delimiter == '\t' ? std::string("tabs")
                                                : fmt::format("'{}'", layout_.delimiter)));
  }
  for (std::size_t c = 0; c < fields.size(); ++c) {
    if (!wanted_[c] || is_number(fields[c], row_[c])) continue;
    std::string what = explain_no_number(fields[c]);
    const bool comma = what.ends_with("decimal comma");
    return trouble(fmt::format(
        "{} in column {}; {}", what, layout_.columns[c].name,
        comma
            ? "write decimal points (sed 's/,/./g' does it where ',' separates nothing)"
            : "delete the row or split the file there, or leave the column out with --channel (and "
              "--witness)"));
  }
  return std::nullopt;
}

}  // namespace imunoise::recording
