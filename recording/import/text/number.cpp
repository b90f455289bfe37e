#include "recording/import/text/number.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>

namespace imunoise::recording {
namespace {

// What the text shows of itself in a message: printable, and not a page of it.
std::string quoted(std::string_view text) {
  constexpr std::size_t shown = 40;
  std::string out = "'";
  for (const char c : text.substr(0, shown)) {
    out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  }
  return out + (text.size() > shown ? "...'" : "'");
}

// Takes digits off the front of the text; nothing when there is another number of them.
std::optional<int> take_digits(std::string_view& text, std::size_t count) {
  int value = 0;
  if (text.size() < count) return std::nullopt;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + count, value);
  if (error != std::errc{} || stop != text.data() + count || text.front() == '-')
    return std::nullopt;
  text.remove_prefix(count);
  return value;
}

// One digit or two.
std::optional<int> take_short(std::string_view& text) {
  const auto two = take_digits(text, 2);
  return two ? two : take_digits(text, 1);
}

bool take_char(std::string_view& text, std::string_view any_of) {
  if (text.empty() || any_of.find(text.front()) == std::string_view::npos) return false;
  text.remove_prefix(1);
  return true;
}

// "-24", after the digits before it.
std::optional<int> take_part(std::string_view& text, std::string_view separator) {
  if (!take_char(text, separator)) return std::nullopt;
  return take_digits(text, 2);
}

// ".25", in ns; 0 where there is none. Some apps write ":250".
std::int64_t take_fraction(std::string_view& text) {
  std::int64_t out = 0;
  constexpr std::string_view kDigits = "0123456789";
  const bool colon =
      text.starts_with(':') && text.find_first_not_of(kDigits, 1) == std::string_view::npos;
  if (colon && text.size() != 4) return out;
  if (!take_char(text, colon ? ":" : ".,")) return out;
  std::int64_t unit = 100'000'000;
  while (!text.empty() && std::isdigit(static_cast<unsigned char>(text.front())) != 0) {
    out += (text.front() - '0') * unit;
    unit /= 10;
    text.remove_prefix(1);
  }
  return out;
}

struct Date {
  int year;
  int month;
  int day;
};

// "2026-11-24", "2026/11/24"
std::optional<Date> take_year_first(std::string_view& text) {
  const auto year = take_digits(text, 4);
  const auto month = year ? take_part(text, "-/") : std::nullopt;
  const auto day = month ? take_part(text, "-/") : std::nullopt;
  if (!day) return std::nullopt;
  return Date{*year, *month, *day};
}

// "24.11.2026"; "11/24/2026", where the month comes first if it can.
std::optional<Date> take_year_last(std::string_view& text) {
  const auto first = take_short(text);
  if (!first || text.empty()) return std::nullopt;
  const std::string_view separator = text.front() == '/' ? "/" : ".";
  const bool slash = text.front() == '/';
  const auto second = take_char(text, separator) ? take_short(text) : std::nullopt;
  if (!second || !take_char(text, separator)) return std::nullopt;
  const auto year = take_digits(text, 4);
  if (!year) return std::nullopt;
  return slash && *first <= 12 ? Date{*year, *first, *second} : Date{*year, *second, *first};
}

// Days since 1970; nothing where the text does not begin with a date.
std::optional<std::int64_t> take_date(std::string_view& text) {
  std::string_view rest = text;
  std::optional<Date> known = take_year_first(rest);
  if (!known) {
    rest = text;
    known = take_year_last(rest);
  }
  if (!known || !take_char(rest, "T ")) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(known->year),
                                         std::chrono::month(static_cast<unsigned>(known->month)),
                                         std::chrono::day(static_cast<unsigned>(known->day))};
  if (!date.ok() || known->year < 1700 || known->year > 2200) return std::nullopt;
  text = rest;
  return std::chrono::sys_days(date).time_since_epoch().count();
}

// Hours of a day by a clock of twelve: " PM" behind them. Nothing for hours that it has not.
std::optional<int> of_half_day(std::string_view& text, int hours) {
  std::string_view rest = text;
  take_char(rest, " ");
  const bool noon = rest.starts_with("PM") || rest.starts_with("pm");
  if (!noon && !rest.starts_with("AM") && !rest.starts_with("am")) return hours;
  if (hours < 1 || hours > 12) return std::nullopt;
  text = rest.substr(2);
  return hours % 12 + (noon ? 12 : 0);
}

// "Z", "+01:00", "-0330", " +0200": seconds to subtract. Nothing where something else follows.
std::optional<int> zone_of(std::string_view text) {
  take_char(text, " ");
  if (text.empty() || text == "Z" || text == "UTC") return 0;
  const int sign = text.front() == '-' ? -1 : 1;
  if (!take_char(text, "+-")) return std::nullopt;
  const auto hours = take_digits(text, 2);
  if (!hours) return std::nullopt;
  take_char(text, ":");
  const auto minutes = text.empty() ? std::optional(0) : take_digits(text, 2);
  if (!minutes || !text.empty()) return std::nullopt;
  return sign * (*hours * 3600 + *minutes * 60);
}

}  // namespace

bool is_missing(std::string_view text) {
  constexpr std::array<std::string_view, 8> kWords = {"nan",  "inf", "infinity", "null",
                                                      "none", "na",  "n/a",      ""};
  if (text == "-") return true;
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);
  std::string small(text.substr(0, 10));
  for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::find(kWords.begin(), kWords.end(), small) != kWords.end();
}

bool has_decimal_comma(std::string_view text) {
  if (std::count(text.begin(), text.end(), ',') != 1) return false;
  std::string pointed(text);
  std::replace(pointed.begin(), pointed.end(), ',', '.');
  double value = 0.0;
  return is_number(pointed, value);
}

std::optional<std::int64_t> read_calendar(std::string_view text) {
  const std::optional<std::int64_t> days = take_date(text);
  const auto shown = take_short(text);
  const auto minutes = shown ? take_part(text, ":") : std::nullopt;
  const auto seconds = minutes ? take_part(text, ":") : std::nullopt;
  if (!seconds) return std::nullopt;
  const std::int64_t fraction = take_fraction(text);
  const auto hours = of_half_day(text, *shown);
  if (!hours) return std::nullopt;
  const auto zone = zone_of(text);
  if (!zone || *hours > 24 || *minutes > 59 || *seconds > 60) return std::nullopt;
  const std::int64_t whole = days.value_or(0) * 86400 + *hours * 3600 + *minutes * 60 + *seconds;
  return (whole - *zone) * 1'000'000'000 + fraction;
}

bool is_numeric(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return (error != std::errc::invalid_argument && stop == end) || has_decimal_comma(text);
}

std::string explain_no_number(std::string_view text) {
  if (text.empty()) return "no value";
  if (has_decimal_comma(text)) {
    return fmt::format("{} has a decimal comma", quoted(text));
  }
  if (is_numeric(text)) return fmt::format("{} is not a finite number", quoted(text));
  return fmt::format("{} is not a number", quoted(text));
}

std::string_view trim(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace imunoise::recording
