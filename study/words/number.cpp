#include "study/words/number.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

namespace imunoise::report {
namespace {

constexpr double kMinute = 60.0;
constexpr double kHour = 3600.0;
constexpr double kDay = 86400.0;

int decade(double value) { return static_cast<int>(std::floor(std::log10(std::abs(value)))); }

bool needs_exponent(int decade_of_value) { return decade_of_value < -3 || decade_of_value >= 5; }

// Fixed notation in which a rounded zero has no sign.
std::string fixed(double value, int decimals, Digits style) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.find_first_not_of("-0.") == std::string::npos && text[0] == '-') text.erase(0, 1);
  if (style == Digits::kTypeset && text[0] == '-') text.replace(0, 1, "−");
  return text;
}

std::string power_of_ten(int exponent, Digits style) {
  return style == Digits::kTypeset ? "×10" + superscript(exponent) : fmt::format("e{}", exponent);
}

bool has_interval(double lower, double upper) {
  return std::isfinite(lower) && std::isfinite(upper) && lower < upper;
}

// One rounding for a value and both ends of its interval.
struct Rounding {
  int exponent = 0;  // of the power of ten taken out
  int decimals = 0;  // of what is left
};

Rounding rounding_of(double value, double lower, double upper) {
  const double half = std::max(upper - value, value - lower);
  int place = decade(half);
  if (half / std::pow(10.0, place) < 3.55) --place;
  const double largest = std::max({std::abs(value), std::abs(lower), std::abs(upper)});
  if (value != 0.0) place = std::min(place, decade(value) - 1);
  place = std::max(place, decade(largest) - 11);
  const int magnitude = decade(value != 0.0 ? value : largest);
  Rounding out;
  out.exponent = needs_exponent(magnitude) ? magnitude : 0;
  out.decimals = std::max(0, out.exponent - place);
  return out;
}

std::string mantissa(double value, const Rounding& rounding, Digits style) {
  return fixed(value / std::pow(10.0, rounding.exponent), rounding.decimals, style);
}

std::string spelled(double value, const Rounding& rounding, Digits style) {
  std::string digits = mantissa(value, rounding, style);
  if (rounding.exponent == 0) return digits;
  if (digits.find_first_not_of("0.") == std::string::npos) return "0";
  return digits + power_of_ten(rounding.exponent, style);
}

// Ends so far from the value that they cannot share its power of ten.
bool far_apart(double value, double lower, double upper) {
  const double largest = std::max(std::abs(lower), std::abs(upper));
  return value != 0.0 && largest / std::abs(value) > 1e3;
}

}  // namespace

std::string superscript(int exponent) {
  static constexpr std::array superscripts = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out = exponent < 0 ? "⁻" : "";
  for (const char digit : std::to_string(std::abs(exponent))) {
    out += superscripts.at(static_cast<std::size_t>(digit - '0'));
  }
  return out;
}

std::string number(double value, int significant, Digits style) {
  if (!std::isfinite(value)) return "n/a";
  if (value == 0.0) return "0";
  // Rounding can carry into the next decade: 9.996 with three digits is 10.0.
  const int first = decade(value);
  const double unit = std::pow(10.0, first - significant + 1);
  const int magnitude = decade(std::round(value / unit) * unit);
  if (!needs_exponent(magnitude)) {
    return fixed(value, std::max(0, significant - 1 - magnitude), style);
  }
  return fixed(value / std::pow(10.0, magnitude), significant - 1, style) +
         power_of_ten(magnitude, style);
}

std::string brief(double value, int significant, Digits style) {
  std::string out = number(value, significant, style);
  const std::size_t point = out.find('.');
  if (point == std::string::npos) return out;
  const std::size_t end = std::min({out.find("×"), out.find('e'), out.size()});
  std::size_t kept = out.find_last_not_of('0', end - 1) + 1;
  if (kept == point + 1) kept = point;
  return out.erase(kept, end - kept);
}

std::string rounded(double value, double lower, double upper, Digits style) {
  if (!std::isfinite(value) || !has_interval(lower, upper)) return number(value, 4, style);
  if (far_apart(value, lower, upper)) return number(value, 2, style);
  return spelled(value, rounding_of(value, lower, upper), style);
}

std::string interval(double value, double lower, double upper, Digits style) {
  if (!std::isfinite(value) || !has_interval(lower, upper)) return {};
  if (far_apart(value, lower, upper)) {
    return number(lower, 2, style) + " … " + number(upper, 2, style);
  }
  const Rounding rounding = rounding_of(value, lower, upper);
  return spelled(lower, rounding, style) + " … " + spelled(upper, rounding, style);
}

std::string with_interval(double value, double lower, double upper, Digits style) {
  if (!std::isfinite(value) || !has_interval(lower, upper)) return number(value, 4, style);
  const bool apart = far_apart(value, lower, upper);
  const Rounding rounding = apart ? Rounding{} : rounding_of(value, lower, upper);
  if (!apart && rounding.exponent != 0 && style == Digits::kTypeset) {
    // One power of ten for all three.
    const auto digits = [&](double x) { return mantissa(x, rounding, style); };
    return fmt::format("{} ({} … {}) {}", digits(value), digits(lower), digits(upper),
                       power_of_ten(rounding.exponent, style));
  }
  return fmt::format("{} ({})", rounded(value, lower, upper, style),
                     interval(value, lower, upper, style));
}

std::string duration(double seconds) {
  if (!std::isfinite(seconds)) return "n/a";
  struct TimeUnit {
    double upto;  // s
    double size;  // s
    const char* symbol;
  };
  static constexpr std::array<TimeUnit, 6> time_units = {{{0.9995e-3, 1e-6, "µs"},
                                                          {0.9995, 1e-3, "ms"},
                                                          {2 * kMinute, 1.0, "s"},
                                                          {2 * kHour, kMinute, "min"},
                                                          {2 * kDay, kHour, "h"},
                                                          {HUGE_VAL, kDay, "d"}}};
  const auto* const unit = std::find_if(time_units.begin(), time_units.end() - 1,
                                        [&](const TimeUnit& u) { return seconds < u.upto; });
  const double value = seconds / unit->size;
  std::string digits = fmt::format("{:.{}f}", value, value < 9.95 ? 1 : 0);
  if (digits.ends_with(".0")) digits.resize(digits.size() - 2);
  return digits + " " + unit->symbol;
}

std::string day(std::int64_t ns) {
  if (ns == 0) return "unknown";
  using std::chrono::days;
  const std::chrono::sys_time<std::chrono::nanoseconds> time{std::chrono::nanoseconds(ns)};
  const std::chrono::year_month_day date{std::chrono::floor<days>(time)};
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
}

std::string minute(std::int64_t ns) {
  if (ns == 0) return "unknown";
  constexpr std::int64_t kNanosecondsADay = 86'400'000'000'000;
  const std::int64_t in_day = (ns % kNanosecondsADay + kNanosecondsADay) % kNanosecondsADay;
  const std::int64_t minutes = in_day / 60'000'000'000;
  return fmt::format("{} {:02}:{:02}", day(ns), minutes / 60, minutes % 60);
}

std::string percent(double fraction) {
  if (!std::isfinite(fraction)) return "n/a";
  if (fraction > 0.0 && fraction < 0.005) return "< 1 %";
  return fmt::format("{:.0f} %", 100.0 * fraction);
}

std::string count(std::uint64_t value, Digits style) {
  std::string digits = std::to_string(value);
  const std::string_view space = style == Digits::kTypeset ? "\u202F" : " ";
  for (auto at = digits.size(); at > 3;) {
    at -= 3;
    digits.insert(at, space);
  }
  return digits;
}

std::string signed_sigma(double value, Digits style) {
  if (!std::isfinite(value)) return "n/a";
  return (value >= 0.0 ? "+" : "") + fixed(value, std::abs(value) < 99.95 ? 1 : 0, style);
}

std::string stretch(double from, double until) {
  const double length = until - from;
  const int decimals =
      length > 0.0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(length))), 0, 9) : 3;
  return fmt::format("{:.{}f} to {:.{}f}", from, decimals, until, decimals);
}

std::string p_value(double value, Digits style) {
  return value < 1e-4 ? "< 0.0001" : number(value, 2, style);
}

std::string tick_label(double value) { return fmt::format("{:.6g}", value); }

}  // namespace imunoise::report
