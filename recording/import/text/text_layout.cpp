#include "recording/import/text/text_layout.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "recording/import/table/array_columns.h"
#include "recording/import/table/names.h"
#include "recording/import/table/select.h"
#include "recording/import/table/time_names.h"
#include "recording/import/text/number.h"

namespace imunoise::recording {
namespace {

constexpr std::array<char, 5> kDelimiters = {';', '\t', ',', '|', ' '};

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

bool mostly_numbers(const std::vector<std::string>& fields) {
  const auto numbers = std::count_if(fields.begin(), fields.end(), [](const std::string& field) {
    return is_numeric(field) || read_calendar(field);
  });
  return 2 * numbers > std::ssize(fields);
}

// Of the first row that has more columns than any table, counted before a line of a megabyte
// becomes that many texts; 0: there is none.
std::size_t columns_beyond_all(const std::vector<TextHead::Row>& rows) {
  for (const TextHead::Row& row : rows) {
    for (const char delimiter : kDelimiters) {
      std::size_t columns = 1;
      for (std::size_t i = 1; i < row.text.size(); ++i) {
        const bool one_run = delimiter == ' ' && row.text[i - 1] == ' ';
        columns += row.text[i] == delimiter && !one_run ? 1U : 0U;
      }
      if (columns > kMaximumColumns) return columns;
    }
  }
  return 0;
}

// Fields of each row; one less where all rows but the first end with a delimiter.
std::size_t fields_of(const std::vector<TextHead::Row>& rows, std::size_t row, char delimiter) {
  const std::vector<std::string> fields = split_header(rows[row].text, delimiter);
  const bool ends = row > 0 && delimiter != ' ' && fields.back().empty() &&
                    split_header(rows[0].text, delimiter).size() + 1 == fields.size();
  return ends ? fields.size() - 1 : fields.size();
}

bool agrees(const std::vector<TextHead::Row>& rows, char delimiter) {
  const std::size_t fields = fields_of(rows, 0, delimiter);
  for (std::size_t r = 1; r < rows.size() && fields >= 2; ++r) {
    if (fields_of(rows, r, delimiter) != fields) return false;
  }
  return fields >= 2;
}

// Rows of the head that LabVIEW writes, which may look like a table of two columns.
std::size_t labview_head(const std::vector<TextHead::Row>& rows) {
  std::size_t out = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (rows[r].text.starts_with("***End_of_Header***")) out = r + 1;
  }
  return out;
}

// LabVIEW names a last column for comments, which few rows have.
bool has_comment_column(const std::vector<std::string>& names, std::size_t fields) {
  return names.size() == fields + 1 && names.back() == "Comment";
}

// Where the table begins, and what separates its values.
struct Start {
  char delimiter = ',';
  std::size_t row = 0;
};

// The row of names after a preamble, if nearly all rows after it have as many fields. Numbers that
// no row names do not show where a preamble ends.
std::optional<Start> after_preamble(const std::vector<TextHead::Row>& rows, char delimiter) {
  constexpr double kNearlyAll = 0.9;
  const std::size_t fields = split_header(rows.back().text, delimiter).size();
  if (fields < 2) return std::nullopt;
  const auto is_row = [&](std::size_t r, bool text) {
    const std::vector<std::string> cut = split_header(rows[r].text, delimiter);
    const bool whole = cut.size() == fields || (text && has_comment_column(cut, fields));
    return whole && (kind_of(cut) == Kind::kText) == text;
  };
  std::size_t first = labview_head(rows);
  while (first < rows.size() && !is_row(first, false)) ++first;
  std::size_t names = first;
  while (names > 0 && is_row(names - 1, true)) --names;
  if (names == first || names == 0) return std::nullopt;
  std::size_t alike = 0;
  for (std::size_t r = first; r < rows.size(); ++r)
    alike += split_header(rows[r].text, delimiter).size() == fields ? 1U : 0U;
  if (static_cast<double>(alike) < kNearlyAll * static_cast<double>(rows.size() - first))
    return std::nullopt;
  return Start{delimiter, names};
}

// "[deg/s]" without its brackets; empty where nothing is stated.
std::string unit_in(const std::string& field) {
  const bool square = field.size() > 2 && field.front() == '[' && field.back() == ']';
  const bool round = field.size() > 2 && field.front() == '(' && field.back() == ')';
  const std::string unit = square || round ? field.substr(1, field.size() - 2) : field;
  return is_missing(unit) || unit == "-" ? std::string() : unit;
}

bool is_known_unit(const std::string& unit) {
  return parse_unit(unit).has_value() || (!unit.empty() && time_unit("", unit).has_value());
}

// At least half of what is stated: the others may be of other things.
bool is_row_of_units(const TextHead::Row& row, char delimiter) {
  std::size_t stated = 0;
  std::size_t known = 0;
  for (const std::string& field : split_header(row.text, delimiter)) {
    const std::string unit = unit_in(field);
    if (unit.empty()) continue;
    if (is_numeric(unit)) return false;
    ++stated;
    known += is_known_unit(unit) ? 1U : 0U;
  }
  return known > 0 && 2 * known >= stated;
}

// A word that is a unit ("sec") is no name here.
std::ptrdiff_t known_names(const TextHead::Row& row, char delimiter) {
  const std::vector<std::string> fields = split_header(row.text, delimiter);
  return std::count_if(fields.begin(), fields.end(), [](const std::string& field) {
    const std::string name = parse_header_field(field).name;
    return !is_known_unit(name) && (is_time_name(name) || of_inertia(role_of(name).quantity));
  });
}

// The row of names where all rows have as many fields: of the rows before the numbers the one that
// has the most names of times and sensors.
std::size_t row_of_names(const std::vector<TextHead::Row>& rows, char delimiter) {
  std::size_t first = 0;
  while (first < rows.size() && !mostly_numbers(split_header(rows[first].text, delimiter))) ++first;
  if (first < 2 || first == rows.size()) return 0;
  std::size_t best = 0;
  for (std::size_t r = 1; r < first; ++r) {
    if (known_names(rows[r], delimiter) > known_names(rows[best], delimiter)) best = r;
  }
  return best;
}

Start find_start(const std::vector<TextHead::Row>& rows, std::optional<char> stated) {
  if (stated) {
    if (agrees(rows, *stated)) return {*stated, row_of_names(rows, *stated)};
    return after_preamble(rows, *stated).value_or(Start{*stated, 0});
  }
  for (const char delimiter : kDelimiters) {
    if (agrees(rows, delimiter)) return {delimiter, row_of_names(rows, delimiter)};
  }
  for (const char delimiter : kDelimiters) {
    if (const auto found = after_preamble(rows, delimiter)) return *found;
  }
  // The rows disagree: take what cuts the last one, so that the ragged row can be named.
  for (const char delimiter : kDelimiters) {
    if (split_header(rows.back().text, delimiter).size() >= 2) return {delimiter, 0};
  }
  return {',', 0};
}

// "1,5" in a table whose values are not separated by commas.
bool has_decimal_commas(const std::vector<TextHead::Row>& rows, const TextLayout& layout) {
  if (layout.delimiter == ',') return false;
  for (std::size_t r = layout.header_rows; r < rows.size(); ++r) {
    const std::vector<std::string> fields = split_fields(rows[r].text, layout.delimiter);
    if (std::any_of(fields.begin(), fields.end(), has_decimal_comma)) return true;
  }
  return false;
}

Result<bool> has_header(const TextHead::Row& row, const std::string& file, char delimiter,
                        const ImportOptions& options) {
  if (options.header) return *options.header;
  const std::vector<std::string> fields = split_header(row.text, delimiter);
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
                  file, row.line, explain_no_number(*text)));
}

// Several columns of one name are told apart: gyro, gyro, gyro are gyro_x, gyro_y, gyro_z.
void number_equal_names(TextLayout& layout) {
  std::map<std::string, std::vector<std::size_t>> columns;
  for (std::size_t c = 0; c < layout.columns.size(); ++c)
    columns[layout.columns[c].name].push_back(c);
  for (const auto& [name, equal] : columns) {
    const std::vector<std::string> names = column_names(name, equal.size());
    const bool taken = std::any_of(names.begin(), names.end(),
                                   [&](const auto& one) { return columns.contains(one); });
    if (equal.size() < 2 || taken || equal.size() > kMaximumColumns) continue;
    for (std::size_t i = 0; i < equal.size(); ++i) layout.columns[equal[i]].name = names[i];
    layout.notes.push_back(fmt::format("{} columns are named {}: {} to {} here", equal.size(), name,
                                       names.front(), names.back()));
  }
}

void take_names(TextLayout& layout, const std::vector<std::string>& fields) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    HeaderField field = parse_header_field(fields[i]);
    layout.unnamed.push_back(field.name.empty());
    if (field.name.empty()) field.name = fmt::format("col{}", i + 1);
    layout.columns.push_back(std::move(field));
  }
  number_equal_names(layout);
}

// Rows that end with a delimiter have one column more than the names.
void add_last_column(TextLayout& layout, const TextHead& head) {
  if (head.rows.size() <= layout.header_rows) return;
  const std::size_t fields =
      split_fields(head.rows[layout.header_rows].text, layout.delimiter).size();
  if (fields != layout.columns.size() + 1) return;
  const std::vector<TextHead::Row> rows(
      head.rows.begin() + static_cast<std::ptrdiff_t>(layout.header_rows) - 1, head.rows.end());
  if (!agrees(rows, layout.delimiter)) return;
  layout.unnamed.push_back(true);
  layout.columns.push_back({fmt::format("col{}", fields), ""});
}

// Some loggers write the units into a row of their own, under the names.
Result<bool> take_units(TextLayout& layout, const TextHead& head) {
  const TextHead::Row& row = head.rows[layout.header_rows];
  const std::vector<std::string> fields = split_header(row.text, layout.delimiter);
  if (kind_of(fields) == Kind::kNumbers) return false;
  if (fields.size() != layout.columns.size()) return false;
  const bool some = std::any_of(fields.begin(), fields.end(), [&](const std::string& field) {
    return !is_numeric(field) && parse_unit(unit_in(field)).has_value();
  });
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string unit = unit_in(fields[i]);
    const std::string& name = layout.columns[i].name;
    // Beside units that are known, one of another thing leaves its column out.
    const bool may_be_axis = name.size() == 1 || role_of(name).quantity != Quantity::kUnknown;
    const bool foreign = some && !is_numeric(unit) && !may_be_axis;
    const bool known = unit.empty() || (is_time_name(name) ? time_unit(name, unit).has_value()
                                                           : parse_unit(unit).has_value());
    if (foreign) continue;
    if (known) continue;
    if (kind_of(fields) == Kind::kMixed) return false;  // samples with a flaw: told with its row
    return fail(
        fmt::format("{}: row {}: '{}' is neither a number nor a known unit in column {}; "
                    "correct it or delete the row",
                    head.file, row.line, unit, layout.columns[i].name));
  }
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (layout.columns[i].unit.empty()) layout.columns[i].unit = unit_in(fields[i]);
  }
  return true;
}

}  // namespace

bool have_one_shape(const std::vector<TextHead::Row>& rows) {
  return rows.empty() || columns_beyond_all(rows) > 0 ||
         std::any_of(kDelimiters.begin(), kDelimiters.end(),
                     [&](char delimiter) { return agrees(rows, delimiter); });
}

bool hold_few_numbers(const std::vector<TextHead::Row>& rows) {
  if (columns_beyond_all(rows) > 0) return false;
  return std::none_of(rows.begin(), rows.end(), [](const TextHead::Row& row) {
    return std::any_of(kDelimiters.begin(), kDelimiters.end(), [&](char delimiter) {
      return mostly_numbers(split_header(row.text, delimiter));
    });
  });
}

Result<TextLayout> detect_layout(const TextHead& head, const ImportOptions& options) {
  if (const std::size_t columns = columns_beyond_all(head.rows); columns > 0) {
    return fail(fmt::format("{}: {} columns, more than the {} allowed; is the table transposed?",
                            head.file, columns, kMaximumColumns));
  }
  if (head.rows.empty()) {
    return fail(
        fmt::format("{}: holds no rows; record again or check how it was exported", head.file));
  }
  TextLayout layout;
  const Start start = find_start(head.rows, options.delimiter);
  layout.delimiter = start.delimiter;
  layout.header_rows = start.row;
  if (start.row > 0) {
    const std::size_t last = head.rows[start.row - 1].line;
    layout.notes.push_back(last == head.rows.front().line
                               ? fmt::format("row {} comes before the table: left out", last)
                               : fmt::format("rows {} to {} come before the table: left out",
                                             head.rows.front().line, last));
  }
  const TextHead::Row& top = head.rows[start.row];
  const Result<bool> header = has_header(top, head.file, layout.delimiter, options);
  if (!header) return tl::make_unexpected(header.error());
  std::vector<std::string> first = split_header(top.text, layout.delimiter);
  const std::size_t fields = split_header(head.rows.back().text, layout.delimiter).size();
  if (has_comment_column(first, fields)) first.pop_back();
  if (*header) {
    take_names(layout, first);
    ++layout.header_rows;
    const bool row_between = head.rows.size() > layout.header_rows + 1 &&
                             is_row_of_units(head.rows[layout.header_rows + 1], layout.delimiter) &&
                             !is_row_of_units(head.rows[layout.header_rows], layout.delimiter);
    if (row_between) ++layout.header_rows;
    if (head.rows.size() > layout.header_rows) {
      const Result<bool> units = take_units(layout, head);
      if (!units) return tl::make_unexpected(units.error());
      if (*units) ++layout.header_rows;
    }
    add_last_column(layout, head);
    layout.decimal_comma = has_decimal_commas(head.rows, layout);
    return layout;
  }
  layout.decimal_comma = has_decimal_commas(head.rows, layout);
  // "#timestamp [ns],w_x [rad s^-1]": several public data sets comment their header out. Words
  // between blanks could be any sentence: some of them must be names that are known.
  const std::vector<std::string> comment = split_header(head.last_comment, layout.delimiter);
  const auto is_known = [](const std::string& field) {
    const std::string name = parse_header_field(field).name;
    return is_time_name(name) || role_of(name).quantity != Quantity::kUnknown;
  };
  const bool names =
      layout.delimiter != ' ' || std::count_if(comment.begin(), comment.end(), is_known) > 1;
  if (!options.header && names && first.size() >= 2 && comment.size() == first.size() &&
      kind_of(comment) == Kind::kText) {
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
