#pragma once

#include <fmt/format.h>

#include <concepts>
#include <string>
#include <string_view>

namespace imunoise {

/// A noun as it is written after a number: "sample" after 1, else "samples", "stretches".
std::string plural(std::integral auto count, std::string_view noun) {
  if (count == 1) return std::string(noun);
  const bool hisses = noun.ends_with("ch") || noun.ends_with("sh");
  return fmt::format("{}{}", noun, hisses ? "es" : "s");
}

/// "1 sample", "2 samples".
std::string counted(std::integral auto count, std::string_view noun) {
  return fmt::format("{} {}", count, plural(count, noun));
}

}  // namespace imunoise
