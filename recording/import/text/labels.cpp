#include "recording/import/text/labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "recording/import/text/number.h"

namespace imunoise::recording {
namespace {

bool is_gap(char c) { return c == ' ' || c == '\t'; }
bool is_separator(char c) { return is_gap(c) || c == ',' || c == ';' || c == '|'; }
bool in_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '[' ||
         c == ']';
}

// The length of a label that begins here, its mark included; 0: none does.
std::size_t label_at(std::string_view text) {
  if (text.empty() || std::isalpha(static_cast<unsigned char>(text.front())) == 0) return 0;
  std::size_t end = 0;
  while (end < text.size() && in_word(text[end])) ++end;
  while (end < text.size() && is_gap(text[end])) ++end;
  const bool marked = end < text.size() && (text[end] == ':' || text[end] == '=');
  return marked ? end + 1 : 0;
}

std::string by_tabs(const std::vector<std::string>& parts) {
  return fmt::format("{}", fmt::join(parts, "\t"));
}

}  // namespace

std::optional<LabelledRow> take_labels(std::string_view row) {
  row = trim(row);
  if (label_at(row) == 0) return std::nullopt;
  LabelledRow out;
  while (!row.empty()) {
    const std::size_t label = label_at(row);
    if (label == 0) return std::nullopt;
    out.labels.emplace_back(trim(row.substr(0, label - 1)));
    row.remove_prefix(label);
    std::size_t end = 0;
    // A label follows a separator.
    while (end < row.size() &&
           (end == 0 || !is_separator(row[end - 1]) || label_at(row.substr(end)) == 0))
      ++end;
    std::string_view value = row.substr(0, end);
    while (!value.empty() && is_separator(value.back())) value.remove_suffix(1);
    out.values.emplace_back(trim(value));
    row.remove_prefix(end);
  }
  return out;
}

std::string without_labels(std::string_view row, const std::vector<std::string>& labels) {
  const auto taken = take_labels(row);
  return taken && taken->labels == labels ? by_tabs(taken->values) : std::string(row);
}

std::vector<std::string> name_by_labels(std::vector<TextHead::Row>& rows) {
  constexpr std::size_t kOthers = 10;  // of a hundred rows, at most
  if (rows.empty()) return {};
  const auto last = take_labels(rows.back().text);
  if (!last || last->labels.size() < 2 ||
      !std::all_of(last->values.begin(), last->values.end(), is_numeric))
    return {};
  const auto is_labelled = [&](const TextHead::Row& row) {
    const auto taken = take_labels(row.text);
    return taken && taken->labels == last->labels;
  };
  const auto labelled =
      static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), is_labelled));
  if (100 * (rows.size() - labelled) > kOthers * rows.size()) return {};
  rows.erase(rows.begin(), std::find_if(rows.begin(), rows.end(), is_labelled));
  for (TextHead::Row& row : rows) row.text = without_labels(row.text, last->labels);
  rows.insert(rows.begin(), {rows.front().line, by_tabs(last->labels)});
  return last->labels;
}

}  // namespace imunoise::recording
