#pragma once

// The form of a model as people write it; what its words mean is the matter of grammar.h.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"

namespace imunoise {

/// What stands between two commas in the brackets of a term. Views are parts of the model's text,
/// without blanks around them: their place is the place to point at.
struct Argument {
  std::string_view text;   ///< all of it
  std::string_view name;   ///< before the sign; all of it where there is none
  std::string_view sign;   ///< "=", "~" or ""
  std::string_view value;  ///< behind the sign
};

/// `count * name(arguments)[sharing]`.
struct WrittenTerm {
  std::string_view text;  ///< from the count on
  int count = 1;
  std::string_view name;
  std::vector<Argument> arguments;
  std::optional<std::string_view> sharing;  ///< what stands in square brackets
};

/// Splits a model into its terms:
///   model := term { '+' term };  term := [ count '*' ] NAME [ '(' [ item { ',' item } ] ')' ]
///   [ '[' word ']' ];  item := [ name ] [ ( '=' | '~' ) value ]
/// A name is letters, digits and '_'; an item is any text with balanced brackets. The terms are
/// views of the text. Error: as model_error().
Result<std::vector<WrittenTerm>> split_model(std::string_view text);

/// "model: WHAT", the text, and a caret under the character where `place` begins, a part of it.
Error model_error(std::string_view text, std::string_view place, const std::string& what);

/// The number that is all of a text; none where it is anything else, infinite or no number.
std::optional<double> number_in(std::string_view text);

}  // namespace imunoise
