#pragma once

#include <string_view>

namespace imunoise::report {

/// What the p-value of a goodness-of-fit test says of a model.
enum class Verdict {
  kFits,      ///< p ≥ 5 %
  kDoubtful,  ///< 1 % ≤ p < 5 %
  kFails,     ///< p < 1 %
  kUntested,  ///< No degrees of freedom are left, or no p-value was given.
};

/// kUntested where the p-value is no number.
Verdict verdict_at(double p_value);
/// True where it is doubtful or worse: then a figure marks where.
bool fails(Verdict verdict);
/// "fits", "doubtful", "does not fit", "not tested".
std::string_view verdict_words(Verdict verdict);

}  // namespace imunoise::report
