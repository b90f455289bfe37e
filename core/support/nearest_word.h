#pragma once

#include <span>
#include <string>
#include <string_view>

namespace imunoise {

/// The known word that `word` probably means, in any case of its letters: that of the fewest
/// changed, added, missing or swapped letters, at most a third of them, else the first that begins
/// with `word` (three letters or more). Empty where none is near.
std::string_view nearest_word(std::string_view word, std::span<const std::string> known);

/// "did you mean 'fit'?", or "" where nothing is near.
std::string did_you_mean(std::string_view word, std::span<const std::string> known);

}  // namespace imunoise
