#include "recording/import/text/number.h"

#include <fmt/core.h>

#include <algorithm>

namespace imunoise::recording {
namespace {

// "1,5": one comma, and a number once it is a point.
bool has_decimal_comma(std::string_view text) {
  if (std::count(text.begin(), text.end(), ',') != 1) return false;
  std::string pointed(text);
  std::replace(pointed.begin(), pointed.end(), ',', '.');
  double value = 0.0;
  return is_number(pointed, value);
}

// What the text shows of itself in a message: printable, and not a page of it.
std::string quoted(std::string_view text) {
  constexpr std::size_t shown = 40;
  std::string out = "'";
  for (const char c : text.substr(0, shown)) {
    out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  }
  return out + (text.size() > shown ? "...'" : "'");
}

}  // namespace

bool is_numeric(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return (error != std::errc::invalid_argument && stop == end) || has_decimal_comma(text);
}

std::string explain_no_number(std::string_view text) {
  if (text.empty()) return "no value";
  if (has_decimal_comma(text)) {
    return fmt::format("{} has a decimal comma", quoted(text));
  }
  if (is_numeric(text)) return fmt::format("{} is not a finite number", quoted(text));
  return fmt::format("{} is not a number", quoted(text));
}

std::string_view trim(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace imunoise::recording
