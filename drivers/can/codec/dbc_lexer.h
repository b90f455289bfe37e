#pragma once

// Words of a DBC file, each with its place.

#include <cstddef>
#include <string>
#include <string_view>

#include "core/support/result.h"

namespace imunoise::drivers {

struct DbcToken {
  enum class Kind { kEnd, kName, kNumber, kText, kMark };
  Kind kind = Kind::kEnd;
  std::string_view text;  ///< As written; of a text, what stands between the quotes.
  std::size_t line = 1;
  std::size_t column = 1;

  bool is(std::string_view word) const { return kind != Kind::kText && text == word; }
};

/// Hands out one token after the other. Names are letters, digits and underscores; marks single
/// characters; a sign belongs to a number when digits follow it.
class DbcLexer {
 public:
  DbcLexer(std::string_view text, std::string_view file) : rest_(text), file_(file) {}

  /// The next token, and from the end on kEnd. Error: a text without its closing quote.
  Result<DbcToken> next();

  /// "file:line:column: what", the place of `token`.
  Error error_at(const DbcToken& token, std::string_view what) const;

 private:
  void skip(std::size_t count);

  std::string_view rest_;
  std::string file_;
  std::size_t line_ = 1;
  std::size_t column_ = 1;
};

}  // namespace imunoise::drivers
