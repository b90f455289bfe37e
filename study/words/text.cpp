#include "study/words/text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "core/support/utf8.h"

namespace imunoise::report {
namespace {

bool is_control(char32_t c) {
  const bool c0_c1 = c < 0x20 || (c >= 0x7F && c < 0xA0);
  // Characters that reorder the text after them or hide in it, and those that XML 1.0 does not
  // allow.
  const bool invisible = (c >= 0x200B && c <= 0x200F) || (c >= 0x2028 && c <= 0x202E) ||
                         (c >= 0x2066 && c <= 0x2069) || c == 0xFEFF || (c & 0xFFFEU) == 0xFFFEU;
  return c0_c1 || invisible;
}

std::size_t columns_of(char32_t c) {
  const bool combining = (c >= 0x0300 && c <= 0x036F) || (c >= 0x1AB0 && c <= 0x1AFF) ||
                         (c >= 0x20D0 && c <= 0x20FF) || (c >= 0xFE00 && c <= 0xFE0F);
  if (combining) return 0;
  const bool wide = (c >= 0x1100 && c <= 0x115F) || (c >= 0x2E80 && c <= 0xA4CF) ||
                    (c >= 0xAC00 && c <= 0xD7A3) || (c >= 0xF900 && c <= 0xFAFF) ||
                    (c >= 0xFE30 && c <= 0xFE6F) || (c >= 0xFF00 && c <= 0xFF60) ||
                    (c >= 0x1F300 && c <= 0x1FAFF) || (c >= 0x20000 && c <= 0x3FFFD);
  return wide ? 2 : 1;
}

std::string_view ascii_spelling(char32_t c) {
  static constexpr std::array<std::pair<char32_t, std::string_view>, 24> spellings = {{
      {U'°', "deg"}, {U'µ', "u"},  {U'μ', "u"},   {U'²', "^2"}, {U'³', "^3"}, {U'≈', "~"},
      {U'σ', "s"},   {U'ν', "v"},  {U'φ', "phi"}, {U'γ', "g"},  {U'ω', "w"},  {U'τ', "tau"},
      {U'χ', "chi"}, {U'±', "+-"}, {U'×', "x"},   {U'·', "*"},  {U'−', "-"},  {U'–', "-"},
      {U'—', "-"},   {U'…', ".."}, {U'≥', ">="},  {U'≤', "<="}, {U'‘', "'"},  {U'’', "'"},
  }};
  const auto* const found = std::find_if(spellings.begin(), spellings.end(),
                                         [c](const auto& spelling) { return spelling.first == c; });
  return found == spellings.end() ? "?" : found->second;
}

}  // namespace

char32_t next_code_point(std::string_view text, std::size_t& at) {
  const std::size_t length = utf8_sequence(text.substr(at));
  if (length == 0) {
    ++at;
    return kReplacement;
  }
  const char32_t lead = static_cast<unsigned char>(text[at]);
  char32_t code = length == 1 ? lead : lead & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    code = (code << 6U) | (static_cast<unsigned char>(text[at + i]) & 0x3FU);
  }
  at += length;
  return code;
}

void append_utf8(std::string& out, char32_t c) {
  const auto put = [&out](char32_t byte) { out += static_cast<char>(byte); };
  if (c < 0x80) {
    put(c);
  } else if (c < 0x800) {
    put(0xC0U | (c >> 6U));
    put(0x80U | (c & 0x3FU));
  } else if (c < 0x10000) {
    put(0xE0U | (c >> 12U));
    put(0x80U | ((c >> 6U) & 0x3FU));
    put(0x80U | (c & 0x3FU));
  } else {
    put(0xF0U | (c >> 18U));
    put(0x80U | ((c >> 12U) & 0x3FU));
    put(0x80U | ((c >> 6U) & 0x3FU));
    put(0x80U | (c & 0x3FU));
  }
}

std::string clean_text(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const char32_t c = next_code_point(text, at);
    const bool space = c == U'\n' || c == U'\r' || c == U'\t';
    append_utf8(out, space ? U' ' : is_control(c) ? kReplacement : c);
  }
  return out;
}

std::string escape_markup(std::string_view text) {
  std::string out;
  for (const char c : clean_text(text)) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::size_t display_width(std::string_view text) {
  std::size_t columns = 0;
  for (std::size_t at = 0; at < text.size();) columns += columns_of(next_code_point(text, at));
  return columns;
}

std::string shorten(std::string_view text, std::size_t columns, std::string_view ellipsis) {
  if (display_width(text) <= columns) return std::string(text);
  const std::size_t tail = display_width(ellipsis);
  if (tail > columns) return {};
  std::size_t used = 0;
  std::size_t end = 0;
  for (std::size_t at = 0; at < text.size(); end = at) {
    used += columns_of(next_code_point(text, at));
    if (used + tail > columns) break;
  }
  return std::string(text.substr(0, end)).append(ellipsis);
}

std::string to_ascii(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const char32_t c = next_code_point(text, at);
    if (c < 0x80) {
      out += static_cast<char>(c);
    } else if (c == U'√') {
      // A root covers the letters behind it: √Hz is sqrt(Hz).
      out += "sqrt(";
      while (at < text.size() && std::isalpha(static_cast<unsigned char>(text[at])) != 0) {
        out += text[at++];
      }
      out += ')';
    } else {
      out += ascii_spelling(c);
    }
  }
  return out;
}

}  // namespace imunoise::report
