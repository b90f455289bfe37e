#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace imunoise {

/// A number in a sentence: two digits, and no exponent where it is large ("38000").
inline std::string rough(double number) {
  if (!(std::abs(number) >= 100.0) || std::isinf(number)) return fmt::format("{:.2g}", number);
  const double step = std::pow(10.0, std::floor(std::log10(std::abs(number))) - 1.0);
  return fmt::format("{:.0f}", std::round(number / step) * step);
}

}  // namespace imunoise
