#include "drivers/text/codec/columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "drivers/text/codec/numbers.h"

namespace imunoise::text {
namespace {

constexpr std::string_view kSpaces = " \t\r";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kSpaces);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kSpaces) - begin + 1);
}

// A name and what stands in brackets behind it.
std::pair<std::string_view, std::string_view> name_and_unit(std::string_view field) {
  const std::size_t open = field.find_first_of("[(");
  if (open == std::string_view::npos) return {field, {}};
  const char close = field[open] == '[' ? ']' : ')';
  if (field.back() != close) return {field, {}};
  return {trimmed(field.substr(0, open)), trimmed(field.substr(open + 1, field.size() - open - 2))};
}

std::int64_t nanoseconds_of(std::string_view unit) {
  if (unit == "s") return 1'000'000'000;
  if (unit == "ms") return 1'000'000;
  if (unit == "us" || unit == "µs") return 1'000;
  return unit == "ns" ? 1 : 0;
}

Result<Column> column_of(std::string_view field) {
  if (field == "-") return Column{ColumnRole::kPassedOver, {}, "1", 0};
  const auto [name, unit] = name_and_unit(field);
  if (name == "counter") return Column{ColumnRole::kCounter, {}, "1", 0};
  if (name == "time") {
    const std::int64_t nanoseconds = nanoseconds_of(unit);
    if (nanoseconds == 0)
      return fail(
          fmt::format("columns: {} needs a unit: time[s], time[ms], time[us] or time[ns]", field));
    return Column{ColumnRole::kTime, {}, "1", nanoseconds};
  }
  if (name.empty() || name.find('/') != std::string_view::npos)
    return fail(
        fmt::format("columns: '{}' is no name; write gyro_x[deg/s], or - for a column that "
                    "is not recorded",
                    field));
  return Column{ColumnRole::kValue, std::string(name), unit.empty() ? "1" : std::string(unit), 0};
}

}  // namespace

Result<std::vector<Column>> parse_columns(std::string_view text) {
  return parse_columns(split(text, Separator::kComma));
}

Result<std::vector<Column>> parse_columns(const std::vector<std::string_view>& fields) {
  std::vector<Column> out;
  std::set<std::string> names;
  std::size_t counters = 0;
  for (const std::string_view field : fields) {
    const Result<Column> one = column_of(field);
    if (!one) return tl::unexpected(one.error());
    if (one->role == ColumnRole::kValue && !names.insert(one->name).second)
      return fail(fmt::format("columns: {} stands twice", one->name));
    counters += one->role == ColumnRole::kCounter ? 1U : 0U;
    out.push_back(*one);
  }
  if (counters > 1) return fail("columns: a device has one counter");
  if (names.empty()) return fail("columns: no channel is named");
  return out;
}

Separator separator_of(std::string_view line) {
  if (line.find(';') != std::string_view::npos) return Separator::kSemicolon;
  return line.find(',') != std::string_view::npos ? Separator::kComma : Separator::kSpace;
}

std::vector<std::string_view> split(std::string_view line, Separator separator) {
  const std::string_view marks = separator == Separator::kComma       ? ","
                                 : separator == Separator::kSemicolon ? ";"
                                                                      : " \t";
  std::vector<std::string_view> out;
  line = trimmed(line);
  while (!line.empty() || separator != Separator::kSpace) {
    const std::size_t end = line.find_first_of(marks);
    out.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) break;
    line.remove_prefix(end + 1);
    if (separator == Separator::kSpace) line = trimmed(line);
  }
  return out;
}

bool is_header(const std::vector<std::string_view>& fields) {
  return !fields.empty() && std::none_of(fields.begin(), fields.end(), [](std::string_view field) {
    return field.empty() || number_of(field).has_value();
  });
}

}  // namespace imunoise::text
