#pragma once

#include <span>
#include <string>
#include <string_view>

namespace imunoise::config {

/// The known name that `name` probably means: that of the fewest changed, added or
/// missing letters. Empty where none is near: more than a third of the letters differ.
std::string_view nearest(std::string_view name, std::span<const std::string> known);

}  // namespace imunoise::config
