#pragma once

// Lengths of time and amounts of data as people write them.

#include <cstdint>
#include <string>
#include <string_view>

#include "core/support/result.h"

namespace imunoise::config {

/// Seconds of "2h", "90 s", "1 h 30 min", "500 ms", "7 d". At least 0, at most a hundred years.
/// Error: no unit, an unknown one, not a number.
Result<double> parse_duration(std::string_view text);
/// The inverse, in whole units where there are: "2 h", "1 h 30 min", "0 s". To the millisecond.
std::string print_duration(double seconds);

/// Bytes of "20 GB" (10^9) or "512 MiB" (2^20). Error: as parse_duration(), beyond 2^63.
Result<std::uint64_t> parse_bytes(std::string_view text);
/// "12.3 GB"
std::string print_bytes(double bytes);

}  // namespace imunoise::config
