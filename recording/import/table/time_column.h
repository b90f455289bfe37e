#pragma once

// The time column as the file holds it. Its unit is judged later, from name, values and steps.

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace imunoise::recording {

/// Stamps as the file holds them: nanoseconds since 1970 do not fit into a double.
using Stamps = std::variant<std::vector<double>, std::vector<std::int64_t>>;

struct TimeColumn {
  std::string name;       ///< As the file calls it: "timestamp".
  std::string unit;       ///< As the file writes it; empty: it does not say.
  Stamps stamps;          ///< One a row, finite.
  bool calendar = false;  ///< Dates and times of day: ns since 1970 UTC (or since midnight).
  std::string said{};     ///< How it was recognised, if its stamps were converted; else empty.
};

inline std::size_t size(const Stamps& stamps) {
  return std::visit([](const auto& values) { return values.size(); }, stamps);
}

}  // namespace imunoise::recording
