#include "drivers/text/codec/numbers.h"

#include <cctype>
#include <charconv>
#include <cmath>

namespace imunoise::text {
namespace {

// Without a label "ax=" or "ax:", and without a plus sign.
std::string_view bare(std::string_view field) {
  const bool labelled = !field.empty() && std::isalpha(static_cast<unsigned char>(field[0])) != 0;
  const std::size_t label = field.find_last_of("=:");
  if (labelled && label != std::string_view::npos) field.remove_prefix(label + 1);
  while (field.starts_with(' ')) field.remove_prefix(1);
  if (field.starts_with('+')) field.remove_prefix(1);
  return field;
}

template <class Number>
std::optional<Number> read_whole(std::string_view field) {
  Number out{};
  const char* const end = field.data() + field.size();
  const auto [stop, error] = std::from_chars(field.data(), end, out);
  if (error != std::errc() || stop != end) return std::nullopt;
  return out;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

std::optional<double> number_of(std::string_view field) { return read_whole<double>(bare(field)); }

std::optional<std::uint64_t> count_of(std::string_view field) {
  return read_whole<std::uint64_t>(bare(field));
}

std::optional<std::int64_t> time_of(std::string_view field, std::int64_t unit_ns) {
  field = bare(field);
  if (field.find_first_of("eE") != std::string_view::npos) {
    const auto number = read_whole<double>(field);
    const double ns = number ? *number * static_cast<double>(unit_ns) : NAN;
    if (!(std::abs(ns) < 9.2e18)) return std::nullopt;
    return std::llround(ns);
  }
  const std::size_t point = field.find('.');
  const auto whole = read_whole<std::int64_t>(field.substr(0, point));
  std::int64_t out = 0;
  if (!whole || __builtin_mul_overflow(*whole, unit_ns, &out)) return std::nullopt;
  if (point == std::string_view::npos) return out;
  const std::int64_t sign = field.starts_with('-') ? -1 : 1;
  std::int64_t digit_ns = unit_ns;
  for (const char c : field.substr(point + 1)) {
    if (!is_digit(c)) return std::nullopt;
    digit_ns /= 10;
    if (__builtin_add_overflow(out, sign * digit_ns * (c - '0'), &out)) return std::nullopt;
  }
  return out;
}

}  // namespace imunoise::text
