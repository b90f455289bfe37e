#pragma once

// Numbers as devices print them.

#include <cstdint>
#include <optional>
#include <string_view>

namespace imunoise::text {

/// A decimal number, with a label before it passed over ("ax=0.1", "ax:0.1");
/// "nan" is one. Empty where the field is no number.
std::optional<double> number_of(std::string_view field);

/// A whole number, not negative.
std::optional<std::uint64_t> count_of(std::string_view field);

/// A time of decimal digits in units of `unit_ns`, in ns; exact, with what is finer than 1 ns left
/// out. Empty where the field is no such time, or beyond 292 years.
std::optional<std::int64_t> time_of(std::string_view field, std::int64_t unit_ns);

}  // namespace imunoise::text
