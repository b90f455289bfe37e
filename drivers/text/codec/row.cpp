#include "drivers/text/codec/row.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "drivers/text/codec/numbers.h"

namespace imunoise::text {
namespace {

// After the last value that the time column can have. 0: it never starts again.
std::int64_t modulus_of(const std::vector<Column>& columns, const LineForm& form) {
  const auto time = std::find_if(columns.begin(), columns.end(),
                                 [](const Column& one) { return one.role == ColumnRole::kTime; });
  if (!form.time_maximum || time == columns.end()) return 0;
  const double ns = (*form.time_maximum + 1.0) * static_cast<double>(time->nanoseconds);
  return ns < 4e18 ? std::llround(ns) : 0;
}

bool is_remark(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  return first == std::string_view::npos || line[first] == '#' || line[first] == '%';
}

}  // namespace

std::variant<std::string_view, NoRow> content_of(std::string_view line, const LineForm& form) {
  while (line.ends_with('\r')) line.remove_suffix(1);
  if (!line.starts_with(form.prefix) || is_remark(line)) return NoRow::kPassedOver;
  if (form.checksum) {
    const std::size_t star = line.find_last_of('*');
    if (!line.starts_with('$') || star == std::string_view::npos || star + 3 != line.size())
      return NoRow::kBadChecksum;
    unsigned told = 0;
    const char* const end = line.data() + line.size();
    if (std::from_chars(line.data() + star + 1, end, told, 16).ptr != end)
      return NoRow::kBadChecksum;
    unsigned found = 0;
    for (const char c : line.substr(1, star - 1)) found ^= static_cast<unsigned char>(c);
    if (found != told) return NoRow::kBadChecksum;
    line = line.substr(0, star);
  }
  line.remove_prefix(form.prefix.size());
  return line;
}

RowReader::RowReader(std::vector<Column> columns, Separator separator, LineForm form)
    : columns_(std::move(columns)),
      separator_(separator),
      form_(std::move(form)),
      modulus_ns_(modulus_of(columns_, form_)),
      unwrap_(std::max<std::int64_t>(1, modulus_ns_)) {}

void RowReader::restart() { unwrap_ = drivers::Unwrapper(unwrap_.modulus()); }

std::variant<TextRow, NoRow> RowReader::read(std::string_view line) {
  const auto content = content_of(line, form_);
  if (const NoRow* const none = std::get_if<NoRow>(&content)) return *none;
  const std::vector<std::string_view> fields =
      split(std::get<std::string_view>(content), separator_);
  if (is_header(fields)) return NoRow::kPassedOver;
  if (fields.size() != columns_.size()) return NoRow::kMalformed;
  TextRow out;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    switch (columns_[i].role) {
      case ColumnRole::kPassedOver:
        break;
      case ColumnRole::kValue: {
        const auto number = number_of(fields[i]);
        if (!number && !fields[i].empty()) return NoRow::kMalformed;
        out.values.push_back(number && std::isfinite(*number) ? number : std::nullopt);
        break;
      }
      case ColumnRole::kCounter:
        out.counter = count_of(fields[i]);
        if (!out.counter) return NoRow::kMalformed;
        break;
      case ColumnRole::kTime: {
        const auto time = time_of(fields[i], columns_[i].nanoseconds);
        std::int64_t sum = out.time_ns.value_or(0);
        if (!time || __builtin_add_overflow(sum, *time, &sum)) return NoRow::kMalformed;
        out.time_ns = sum;
        break;
      }
    }
  }
  if (modulus_ns_ > 0 && out.time_ns) {
    if (*out.time_ns < 0 || *out.time_ns >= modulus_ns_) return NoRow::kMalformed;
    out.time_ns = unwrap_(*out.time_ns);
  }
  return out;
}

}  // namespace imunoise::text
