#include "recording/import/text/text_rows.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <set>

#include "core/support/counted.h"
#include "recording/import/table/names.h"
#include "recording/import/table/time_names.h"
#include "recording/import/text/number.h"

namespace imunoise::recording {

std::size_t RowMap::line_of(std::size_t sample) const {
  const auto after = std::upper_bound(runs_.begin(), runs_.end(), sample,
                                      [](std::size_t s, const auto& run) { return s < run.first; });
  return sample + std::prev(after)->second;
}

RowParser::RowParser(std::string file, const TextLayout& layout, const std::vector<bool>& wanted,
                     std::optional<std::size_t> time)
    : file_(std::move(file)),
      layout_(layout),
      wanted_(wanted),
      time_(time),
      values_(layout.columns.size()),
      row_(layout.columns.size()) {}

void RowParser::reserve(std::size_t rows, std::size_t spare) {
  const auto more = [&](auto& values) {
    if (values.capacity() - rows_ < spare) values.reserve(std::max(rows, rows_ + rows_ / 8));
  };
  for (std::size_t c = 0; c < values_.size(); ++c) {
    if (wanted_[c]) more(values_[c]);
  }
  if (time_) std::visit(more, stamps_);
}

std::optional<Error> RowParser::add(std::string_view line, std::size_t line_number) {
  if (layout_.decimal_comma) {
    pointed_.assign(line);
    std::replace(pointed_.begin(), pointed_.end(), ',', '.');
    line = pointed_;
  }
  if (!parse_plain(line)) {
    const std::size_t unreadable = unreadable_;
    if (std::optional<Error> error = parse_with_care(line, line_number)) return error;
    if (time_ && unreadable_ > unreadable) return std::nullopt;  // the times show the hole
  }
  for (std::size_t c = 0; c < values_.size(); ++c) {
    if (wanted_[c]) values_[c].push_back(row_[c]);
  }
  if (time_) {
    if (auto* const whole = std::get_if<std::vector<std::int64_t>>(&stamps_)) {
      whole->push_back(whole_stamp_);
    } else {
      std::get<std::vector<double>>(stamps_).push_back(stamp_);
    }
  }
  row_map_.add(rows_++, line_number);
  return std::nullopt;
}

// Whole numbers stay whole until a stamp has a fraction.
const char* RowParser::read_stamp(const char* begin, const char* end) {
  if (calendar_) return nullptr;
  if (auto* const whole = std::get_if<std::vector<std::int64_t>>(&stamps_)) {
    const auto [stop, error] = std::from_chars(begin, end, whole_stamp_);
    if (error == std::errc{} && (stop == end || (*stop != '.' && *stop != 'e' && *stop != 'E')))
      return stop;
    const char* const as_double = read_number(begin, end, stamp_);
    constexpr std::string_view kDateGoesOn = ".:-/";
    if (as_double == nullptr) return nullptr;
    if (as_double != end && kDateGoesOn.find(*as_double) != std::string_view::npos) return nullptr;
    stamps_ = std::vector<double>(whole->begin(), whole->end());
    return as_double;
  }
  return read_number(begin, end, stamp_);
}

bool RowParser::read_stamp_with_care(std::string_view text) {
  if (const auto calendar = read_calendar(text);
      calendar && std::holds_alternative<std::vector<std::int64_t>>(stamps_) &&
      (calendar_ || rows_ == 0)) {
    calendar_ = true;
    constexpr std::int64_t day = std::int64_t{86'400} * 1'000'000'000;
    const bool of_day = *calendar >= 0 && *calendar <= day;  // no date: midnight starts it again
    if (of_day && last_of_day_ - *calendar > day / 2) midnights_ += day;
    last_of_day_ = of_day ? *calendar : 0;
    whole_stamp_ = *calendar + (of_day ? midnights_ : 0);
    return true;
  }
  const char* const end = text.data() + text.size();
  return !text.empty() && read_stamp(text.data(), end) == end;
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
    } else if (c == time_) {
      at = read_stamp(at, end);
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

// A row of names, most of them of times and sensors, and of other sensors than this table has.
bool RowParser::begins_another_table(const std::vector<std::string>& fields) const {
  std::size_t known = 0;
  std::set<Quantity> here;
  for (const std::string& field : fields) {
    if (is_numeric(field)) return false;
    const std::string name = parse_header_field(field).name;
    const Quantity quantity = role_of(name).quantity;
    if (of_inertia(quantity)) here.insert(quantity);
    known += is_time_name(name) || of_inertia(quantity) ? 1U : 0U;
  }
  std::set<Quantity> above;
  for (const HeaderField& column : layout_.columns) {
    if (const Quantity one = role_of(column.name).quantity; of_inertia(one)) above.insert(one);
  }
  const bool other = !std::includes(above.begin(), above.end(), here.begin(), here.end());
  return known > 1 && 2 * known > fields.size() && other;
}

std::optional<Error> RowParser::leave_out(const std::vector<std::string>& fields,
                                          std::size_t line_number, const std::string& what) {
  if (begins_another_table(fields))
    return Error{
        fmt::format("{}: row {}: a second table begins here ({}, {}, ...); save each table in its "
                    "own file",
                    file_, line_number, fields[0], fields[1])};
  if (unreadable_++ == 0) first_unreadable_ = fmt::format("row {}: {}", line_number, what);
  std::fill(row_.begin(), row_.end(), std::numeric_limits<double>::quiet_NaN());
  return std::nullopt;
}

// Quoted numbers, missing values, and every kind of trouble.
std::optional<Error> RowParser::parse_with_care(std::string_view line, std::size_t line_number) {
  const std::vector<std::string> fields = split_fields(line, layout_.delimiter);
  if (fields.size() != row_.size()) {
    return leave_out(
        fields, line_number,
        fmt::format("{} where the table has {} columns (separated by {})",
                    counted(fields.size(), "value"), row_.size(),
                    layout_.delimiter == ' '    ? std::string("blanks")
                    : layout_.delimiter == '\t' ? std::string("tabs")
                                                : fmt::format("'{}'", layout_.delimiter)));
  }
  for (std::size_t c = 0; c < fields.size(); ++c) {
    if (c == time_ ? read_stamp_with_care(fields[c])
                   : (!wanted_[c] || is_number(fields[c], row_[c])))
      continue;
    if (c != time_ && is_missing(fields[c])) {
      row_[c] = std::numeric_limits<double>::quiet_NaN();
      continue;
    }
    const std::string what =
        fmt::format("{} in column {}", explain_no_number(fields[c]), layout_.columns[c].name);
    if (what.find("decimal comma") == std::string::npos)
      return leave_out(fields, line_number, what);
    return Error{fmt::format(
        "{}: row {}: {}; write decimal points (sed 's/,/./g' does it where ',' separates nothing)",
        file_, line_number, what)};
  }
  return std::nullopt;
}

}  // namespace imunoise::recording
