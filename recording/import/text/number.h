#pragma once

// Numbers in text: how they are read, and what to say about text that is none.

#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace imunoise::recording {

/// Reads one finite decimal number at the start of [begin, end); a leading '+' is allowed. Returns
/// where it ended, or nullptr when there is none, it is not finite or no double can hold it.
inline const char* read_number(const char* begin, const char* end, double& value) {
  if (begin != end && *begin == '+') {
    ++begin;
    if (begin != end && (*begin == '-' || *begin == '+')) return nullptr;
  }
  const auto [stop, error] = std::from_chars(begin, end, value);
  return error == std::errc{} && std::isfinite(value) ? stop : nullptr;
}

/// True when all of `text` is one finite number.
inline bool is_number(std::string_view text, double& value) {
  const char* const end = text.data() + text.size();
  return !text.empty() && read_number(text.data(), end, value) == end;
}

/// True for the words that stand for no value: "", "nan", "null", "NA", "-", "inf".
bool is_missing(std::string_view text);

/// "2026-11-24T11:28:00.25Z", "2026-11-24 11:28:00+01:00", "24.11.2026 11:28:00", "11/24/2026
/// 11:28:00", "11:28:00.25": ns since 1970 UTC, or since midnight where there is no date. Nothing
/// for other text.
std::optional<std::int64_t> read_calendar(std::string_view text);

/// "1,5": one comma, and a number once it is a point.
bool has_decimal_comma(std::string_view text);

/// True when `text` was meant as a number, good or bad: "1.5", "nan", "1e999", "1,5".
bool is_numeric(std::string_view text);

/// Why `text`, for which is_number() is false, is no number: "'abc' is not a number", "'nan' is not
/// finite", "'1,5' has a decimal comma", "no value".
std::string explain_no_number(std::string_view text);

/// `text` without blanks at both ends.
std::string_view trim(std::string_view text);

}  // namespace imunoise::recording
