#include "recording/import/text/fields.h"

#include <fmt/core.h>

#include <utility>

#include "core/support/utf8.h"
#include "recording/import/text/number.h"

namespace imunoise::recording {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t'; }

// Reads a quoted field that starts at `at`, and moves `at` behind its closing quote.
std::string read_quoted(std::string_view line, std::size_t& at) {
  std::string out;
  for (++at; at < line.size(); ++at) {
    if (line[at] == '"') {
      if (at + 1 >= line.size() || line[at + 1] != '"') {
        ++at;
        break;
      }
      ++at;
    }
    out += line[at];
  }
  return out;
}

}  // namespace

std::vector<std::string> split_fields(std::string_view line, char delimiter) {
  const bool blanks = delimiter == ' ';
  const auto is_delimiter = [&](char c) { return blanks ? is_blank(c) : c == delimiter; };
  if (blanks) line = trim(line);
  std::vector<std::string> out;
  std::size_t at = 0;
  while (true) {
    while (at < line.size() && is_blank(line[at]) && (blanks || !is_delimiter(line[at]))) ++at;
    std::string field;
    if (at < line.size() && line[at] == '"') field = read_quoted(line, at);
    // What follows a closing quote belongs to the field: `"a" b` is seen as it is written.
    const std::size_t begin = at;
    while (at < line.size() && !is_delimiter(line[at])) ++at;
    field += trim(line.substr(begin, at - begin));
    out.push_back(std::move(field));
    if (at == line.size()) return out;
    ++at;
  }
}

std::vector<std::string> split_header(std::string_view line, char delimiter) {
  std::vector<std::string> fields = split_fields(line, delimiter);
  if (delimiter != ' ') return fields;
  std::vector<std::string> out;
  bool open = false;
  for (std::string& field : fields) {
    const bool bracket = !field.empty() && (field.front() == '[' || field.front() == '(');
    // Only the field is searched: a line may hold half a million of them in one bracket.
    const std::size_t opening = field.find_last_of("[(");
    const std::size_t closing =
        field.find_first_of("])", opening == std::string::npos ? 0 : opening);
    const bool opens = closing == std::string::npos && (opening != std::string::npos || open);
    if (!out.empty() && (open || bracket)) {
      out.back() += ' ' + field;
    } else {
      out.push_back(std::move(field));
    }
    open = opens;
  }
  return out;
}

HeaderField parse_header_field(std::string_view text) {
  text = trim(text);
  if (!text.empty() && (text.back() == ']' || text.back() == ')')) {
    const std::size_t opening = text.rfind(text.back() == ']' ? '[' : '(');
    if (opening != std::string_view::npos && opening > 0) {
      std::string name(trim(text.substr(0, opening)));
      const std::string_view inside = trim(text.substr(opening + 1, text.size() - opening - 2));
      // "gyro(x)"; "gyro[0]": equal names are numbered later.
      if (inside.size() == 1 && inside.front() >= 'x' && inside.front() <= 'z')
        return {fmt::format("{}_{}", name, inside), ""};
      if (inside.size() == 1 && inside.front() >= '0' && inside.front() <= '9')
        return {std::move(name), ""};
      return {std::move(name), std::string(inside)};
    }
  }
  return {std::string(text), ""};
}

}  // namespace imunoise::recording
