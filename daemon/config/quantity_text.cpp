#include "daemon/config/quantity_text.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <span>

namespace imunoise::config {
namespace {

struct NamedUnit {
  std::string_view name;
  double size;
};

constexpr double kLongest = 100.0 * 365.25 * 86400.0;  // s
constexpr double kMostBytes = 0x1p63;

// From the largest on, one name of each size first: print_duration() goes down the first five.
constexpr std::array<NamedUnit, 12> kTimes = {{{"d", 86400.0},
                                               {"h", 3600.0},
                                               {"min", 60.0},
                                               {"s", 1.0},
                                               {"ms", 1e-3},
                                               {"w", 604800.0},
                                               {"day", 86400.0},
                                               {"days", 86400.0},
                                               {"hour", 3600.0},
                                               {"hours", 3600.0},
                                               {"minutes", 60.0},
                                               {"seconds", 1.0}}};
constexpr std::size_t kPrintedTimes = 5;

constexpr std::array<NamedUnit, 9> kSizes = {{{"TB", 1e12},
                                              {"GB", 1e9},
                                              {"MB", 1e6},
                                              {"kB", 1e3},
                                              {"B", 1.0},
                                              {"KiB", 0x1p10},
                                              {"MiB", 0x1p20},
                                              {"GiB", 0x1p30},
                                              {"TiB", 0x1p40}}};
constexpr std::size_t kPrintedSizes = 5;

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

void skip_blanks(std::string_view& text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
}

std::string names(std::span<const NamedUnit> units) {
  std::string out;
  for (const NamedUnit& unit : units) {
    out += (out.empty() ? "" : ", ") + std::string(unit.name);
  }
  return out;
}

// The sum of "NUMBER UNIT" parts, in the unit of size 1.
Result<double> parse_sum(std::string_view text, std::span<const NamedUnit> units,
                         std::string_view example) {
  const auto trouble = [&](const std::string& what) {
    return fail(fmt::format("'{}': {}; write it as {}", text, what, example));
  };
  std::string_view rest = text;
  double sum = 0.0;
  skip_blanks(rest);
  if (rest.empty()) return trouble("is empty");
  while (!rest.empty()) {
    double number = 0.0;
    const auto [end, error] =
        std::from_chars(rest.data(), rest.data() + rest.size(), number, std::chars_format::fixed);
    if (error != std::errc{} || !(number >= 0.0) || !std::isfinite(number)) {
      return trouble("a number of at least 0 is missing");
    }
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
    skip_blanks(rest);
    std::size_t length = 0;
    while (length < rest.size() && is_letter(rest[length])) ++length;
    const std::string_view name = rest.substr(0, length);
    if (name.empty()) return trouble("a unit is missing");
    const NamedUnit* found = nullptr;
    for (const NamedUnit& unit : units) {
      if (unit.name == name) found = &unit;
    }
    if (found == nullptr) {
      return trouble(fmt::format("unknown unit '{}', the units are {}", name, names(units)));
    }
    sum += number * found->size;
    rest.remove_prefix(length);
    skip_blanks(rest);
  }
  return sum;
}

}  // namespace

Result<double> parse_duration(std::string_view text) {
  auto out = parse_sum(text, kTimes, "\"90 s\", \"10 min\" or \"1 h 30 min\"");
  if (out && *out > kLongest) return fail(fmt::format("'{}' is more than a hundred years", text));
  return out;
}

std::string print_duration(double seconds) {
  double left = std::round(seconds * 1e3);  // ms
  std::string out;
  for (const NamedUnit& unit : std::span(kTimes).first(kPrintedTimes)) {
    const double size = std::round(unit.size * 1e3);
    const double count = std::floor(left / size);
    if (count <= 0.0) continue;
    out += fmt::format("{}{} {}", out.empty() ? "" : " ", count, unit.name);
    left -= count * size;
  }
  return out.empty() ? "0 s" : out;
}

Result<std::uint64_t> parse_bytes(std::string_view text) {
  const auto out = parse_sum(text, kSizes, "\"500 MB\" or \"20 GiB\"");
  if (!out) return tl::make_unexpected(out.error());
  if (*out >= kMostBytes) return fail(fmt::format("'{}' is more than any disk holds", text));
  return static_cast<std::uint64_t>(std::llround(*out));
}

std::string print_bytes(double bytes) {
  for (const NamedUnit& unit : std::span(kSizes).first(kPrintedSizes)) {
    if (bytes >= unit.size) return fmt::format("{:.3g} {}", bytes / unit.size, unit.name);
  }
  return "0 B";
}

}  // namespace imunoise::config
