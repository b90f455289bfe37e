#pragma once

// The words of a column's name.

#include <fmt/format.h>

#include <cctype>
#include <string>
#include <string_view>
#include <vector>

namespace imunoise::recording {

/// In small letters: "imu.angularVelocity_x" is imu, angular, velocity, x.
inline std::vector<std::string> words_of(std::string_view name) {
  const auto is_upper = [](char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; };
  std::vector<std::string> out;
  bool open = false;
  char before = ' ';
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) == 0) {
      open = false;
    } else {
      if (!open || (is_upper(c) && !is_upper(before))) out.emplace_back();
      out.back() += static_cast<char>(std::tolower(byte));
      open = true;
    }
    before = c;
  }
  return out;
}

inline std::string joined_words(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ""));
}

}  // namespace imunoise::recording
