#include "drivers/can/codec/dbc_lexer.h"

#include <fmt/format.h>

#include <cctype>

namespace imunoise::drivers {
namespace {

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_sign(char c) { return c == '+' || c == '-'; }

// Characters of a number at the front of `text`; 0 if there is none.
std::size_t number_length(std::string_view text) {
  const auto at = [&](std::size_t i) { return i < text.size() ? text[i] : '\0'; };
  std::size_t i = is_sign(at(0)) ? 1 : 0;
  const std::size_t first = i;
  while (is_digit(at(i)) || at(i) == '.') ++i;
  if (i == first || !(is_digit(at(first)) || is_digit(at(first + 1)))) return 0;
  if (at(i) == 'e' || at(i) == 'E') {
    std::size_t exponent = i + 1;
    if (is_sign(at(exponent))) ++exponent;
    if (is_digit(at(exponent))) {
      i = exponent;
      while (is_digit(at(i))) ++i;
    }
  }
  return i;
}

}  // namespace

void DbcLexer::skip(std::size_t count) {
  for (const char c : rest_.substr(0, count)) {
    column_ = c == '\n' ? 1 : column_ + 1;
    line_ += c == '\n' ? 1U : 0U;
  }
  rest_.remove_prefix(count);
}

Result<DbcToken> DbcLexer::next() {
  std::size_t blank = 0;
  while (blank < rest_.size() && std::isspace(static_cast<unsigned char>(rest_[blank])) != 0) {
    ++blank;
  }
  skip(blank);
  DbcToken out;
  out.line = line_;
  out.column = column_;
  if (rest_.empty()) return out;
  std::size_t length = 1;
  if (rest_[0] == '"') {
    // A quote within a text is written \".
    while (length < rest_.size() && rest_[length] != '"') length += rest_[length] == '\\' ? 2U : 1U;
    if (length >= rest_.size()) {
      return tl::unexpected(error_at(out, "this text has no closing quote"));
    }
    out.kind = DbcToken::Kind::kText;
    out.text = rest_.substr(1, length - 1);
    skip(length + 1);
    return out;
  }
  if ((length = number_length(rest_)) > 0) {
    out.kind = DbcToken::Kind::kNumber;
  } else if (is_name(rest_[0])) {
    out.kind = DbcToken::Kind::kName;
    while (length < rest_.size() && is_name(rest_[length])) ++length;
  } else {
    out.kind = DbcToken::Kind::kMark;
    length = 1;
  }
  out.text = rest_.substr(0, length);
  skip(length);
  return out;
}

Error DbcLexer::error_at(const DbcToken& token, std::string_view what) const {
  return {fmt::format("{}:{}:{}: {}", file_, token.line, token.column, what)};
}

}  // namespace imunoise::drivers
