#include "daemon/config/toml_depth.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace imunoise::config {
namespace {

constexpr std::size_t kMost = 16;

// Bytes of the text in quotes that begins there.
std::size_t quoted_at(std::string_view text) {
  const char quote = text.front();
  const std::string three(3, quote);
  const bool lines = text.starts_with(three);  // it may hold line breaks
  const std::string_view end = std::string_view(three).substr(0, lines ? 3 : 1);
  std::size_t i = end.size();
  while (i < text.size() && !text.substr(i).starts_with(end)) {
    if (text[i] == '\n' && !lines) return i;  // no TOML: the parser says so
    i += text[i] == '\\' && quote == '"' ? 2U : 1U;
  }
  i = std::min(i + end.size(), text.size());
  // Before the last three quotes of such a text there may be two more.
  for (int more = 0; lines && more < 2 && i < text.size() && text[i] == quote; ++more) ++i;
  return i;
}

// Bytes of what begins there and is to be looked at as a whole.
std::size_t piece_at(std::string_view text) {
  if (text.front() == '#') return std::min(text.find('\n'), text.size());
  return text.front() == '"' || text.front() == '\'' ? quoted_at(text) : 1;
}

void pass(std::string_view piece, Place& place) {
  for (const char c : piece) {
    const bool inside = (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;  // a character
    place.column = c == '\n' ? 1 : place.column + (inside ? 0U : 1U);
    place.line += c == '\n' ? 1U : 0U;
  }
}

}  // namespace

std::optional<Problem> too_deep(std::string_view text) {
  Place place;
  std::size_t open = 0;   // lists and tables
  std::size_t parts = 1;  // of a key, if it is one
  while (!text.empty()) {
    const char c = text.front();
    if (c == '[' || c == '{') ++open;
    if ((c == ']' || c == '}') && open > 0) --open;
    if (c == '.') ++parts;
    if (std::string_view("\n=,[]{}").find(c) != std::string_view::npos) parts = 1;
    if (parts > kMost)
      return Problem{place, "", fmt::format("a key has more than {} parts; no setting has", kMost)};
    if (open > kMost) {
      return Problem{
          place, "",
          fmt::format("lists or tables are nested more than {} deep; no setting is", kMost)};
    }
    const std::size_t piece = piece_at(text);
    pass(text.substr(0, piece), place);
    text.remove_prefix(piece);
  }
  return std::nullopt;
}

}  // namespace imunoise::config
