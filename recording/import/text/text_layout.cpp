#include "recording/import/text/text_layout.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "recording/import/table/names.h"
#include "recording/import/text/number.h"

namespace imunoise::recording {
namespace {

constexpr std::array<char, 3> kDelimiters = {';', '\t', ','};

// A delimiter is right when it cuts every row into the same number of fields, two or more.
char detect_delimiter(const std::vector<TextHead::Row>& rows) {
  const auto agrees = [&](char delimiter) {
    const std::size_t fields = split_header(rows.front().text, delimiter).size();
    return fields >= 2 && std::all_of(rows.begin(), rows.end(), [&](const TextHead::Row& row) {
             return split_header(row.text, delimiter).size() == fields;
           });
  };
  for (const char delimiter : kDelimiters) {
    if (agrees(delimiter)) return delimiter;
  }
  if (agrees(' ')) return ' ';
  // The rows disagree: take what cuts the last one, so that the ragged row can be named.
  for (const char delimiter : {';', '\t', ',', ' '}) {
    if (split_header(rows.back().text, delimiter).size() >= 2) return delimiter;
  }
  return ',';
}

enum class Kind { kNumbers, kText, kMixed };

Kind kind_of(const std::vector<std::string>& fields) {
  bool number = false;
  bool text = false;
  for (const std::string& field : fields) {
    if (field.empty()) continue;
    (is_numeric(field) || read_calendar(field) ? number : text) = true;
  }
  return number && text ? Kind::kMixed : number ? Kind::kNumbers : Kind::kText;
}

Result<bool> has_header(const TextHead& head, char delimiter, const ImportOptions& options) {
  if (options.header) return *options.header;
  const std::vector<std::string> fields = split_header(head.rows.front().text, delimiter);
  switch (kind_of(fields)) {
    case Kind::kNumbers:
      return false;
    case Kind::kText:
      return true;
    case Kind::kMixed:
      break;
  }
  const auto text = std::find_if(fields.begin(), fields.end(), [](const std::string& field) {
    return !field.empty() && !is_numeric(field) && !read_calendar(field);
  });
  return fail(
      fmt::format("{}: row {}: {} while other values are numbers; correct the row, or say "
                  "with --header or --no-header whether it names the columns",
                  head.file, head.rows.front().line, explain_no_number(*text)));
}

void take_names(TextLayout& layout, const std::vector<std::string>& fields) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    HeaderField field = parse_header_field(fields[i]);
    layout.unnamed.push_back(field.name.empty());
    if (field.name.empty()) field.name = fmt::format("col{}", i + 1);
    layout.columns.push_back(std::move(field));
  }
}

// Some loggers write the units into a row of their own, under the names.
Result<bool> take_units(TextLayout& layout, const TextHead& head) {
  const TextHead::Row& row = head.rows[layout.header_rows];
  const std::vector<std::string> fields = split_header(row.text, layout.delimiter);
  if (kind_of(fields) == Kind::kNumbers) return false;
  const auto units = [&](const std::string& text) {
    const std::string unit = text.size() > 2 && text.front() == '[' && text.back() == ']'
                                 ? text.substr(1, text.size() - 2)
                                 : text;
    return unit;
  };
  if (fields.size() != layout.columns.size()) return false;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string unit = units(fields[i]);
    const bool known =
        unit.empty() || unit == "-" ||
        (is_time_name(layout.columns[i].name) ? time_unit(layout.columns[i].name, unit).has_value()
                                              : parse_unit(unit).has_value());
    if (known) continue;
    if (kind_of(fields) == Kind::kMixed) return false;  // samples with a flaw: told with its row
    return fail(
        fmt::format("{}: row {}: '{}' is neither a number nor a known unit in column {}; "
                    "correct it or delete the row",
                    head.file, row.line, unit, layout.columns[i].name));
  }
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (layout.columns[i].unit.empty()) layout.columns[i].unit = units(fields[i]);
  }
  return true;
}

}  // namespace

Result<TextLayout> detect_layout(const TextHead& head, const ImportOptions& options) {
  if (head.rows.empty()) {
    return fail(
        fmt::format("{}: holds no rows; record again or check how it was exported", head.file));
  }
  TextLayout layout;
  layout.delimiter = options.delimiter ? *options.delimiter : detect_delimiter(head.rows);
  const Result<bool> header = has_header(head, layout.delimiter, options);
  if (!header) return tl::make_unexpected(header.error());
  const std::vector<std::string> first = split_header(head.rows.front().text, layout.delimiter);
  if (*header) {
    take_names(layout, first);
    layout.header_rows = 1;
    if (head.rows.size() > 1) {
      const Result<bool> units = take_units(layout, head);
      if (!units) return tl::make_unexpected(units.error());
      if (*units) layout.header_rows = 2;
    }
    return layout;
  }
  // "#timestamp [ns],w_x [rad s^-1]": several public data sets comment their header out. Words
  // between blanks could be any sentence, so this is for explicit delimiters only.
  const std::vector<std::string> comment = split_header(head.last_comment, layout.delimiter);
  if (!options.header && layout.delimiter != ' ' && first.size() >= 2 &&
      comment.size() == first.size() && kind_of(comment) == Kind::kText) {
    take_names(layout, comment);
    return layout;
  }
  for (std::size_t i = 0; i < first.size(); ++i) {
    layout.columns.push_back({fmt::format("col{}", i + 1), ""});
    layout.unnamed.push_back(i > 0 && i + 1 == first.size() && first[i].empty());
  }
  return layout;
}

}  // namespace imunoise::recording
