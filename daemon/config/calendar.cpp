#include "daemon/config/calendar.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <vector>

namespace imunoise::config {
namespace {

constexpr std::string_view kNumbers = "0123456789*,./";

std::vector<std::string> split(std::string_view text, std::string_view separators) {
  std::vector<std::string> out{""};
  for (const char c : text) {
    if (separators.find(c) != std::string_view::npos) {
      out.emplace_back();
    } else {
      out.back() += c;
    }
  }
  return out;
}

std::string in_small(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

bool is_day(const std::string& text) {
  constexpr std::array<std::string_view, 7> kDays = {"monday", "tuesday",  "wednesday", "thursday",
                                                     "friday", "saturday", "sunday"};
  return std::any_of(kDays.begin(), kDays.end(),
                     [&](std::string_view day) { return text == day || text == day.substr(0, 3); });
}

// "Mon", "Mon,Wed..Fri"
bool are_days(std::string_view text) {
  for (const std::string& range : split(text, ",")) {
    const std::size_t dots = range.find("..");
    const std::string first = range.substr(0, dots);
    const std::string last = dots == std::string::npos ? first : range.substr(dots + 2);
    if (!is_day(in_small(first)) || !is_day(in_small(last))) return false;
  }
  return true;
}

// Two to three fields of numbers.
bool are_fields(std::string_view text, std::string_view separators) {
  const std::vector<std::string> fields = split(text, separators);
  return fields.size() >= 2 && fields.size() <= 3 &&
         std::all_of(fields.begin(), fields.end(), [](const std::string& field) {
           return !field.empty() && field.find_first_not_of(kNumbers) == std::string::npos;
         });
}

bool is_date(std::string_view text) { return are_fields(text, "-~"); }
bool is_time(std::string_view text) { return are_fields(text, ":"); }

bool is_date_and_time(std::string_view text) {
  const std::size_t t = text.find('T');
  return t != std::string_view::npos && is_date(text.substr(0, t)) && is_time(text.substr(t + 1));
}

// "UTC", "Europe/Zurich"
bool is_zone(std::string_view text) {
  return std::isupper(static_cast<unsigned char>(text.front())) != 0 &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) {
           return c < 128 &&
                  (std::isalnum(c) != 0 ||
                   std::string_view("/_+-").find(static_cast<char>(c)) != std::string_view::npos);
         });
}

bool is_word(const std::string& text) {
  constexpr std::array<std::string_view, 10> kWords = {
      "minutely", "hourly",    "daily",        "weekly",        "monthly",
      "yearly",   "quarterly", "semiannually", "semi-annually", "annually"};
  return std::find(kWords.begin(), kWords.end(), text) != kWords.end();
}

// "@1395716396": seconds since 1970
bool is_epoch(std::string_view text) {
  return text.size() > 1 && text.front() == '@' &&
         text.substr(1).find_first_not_of("0123456789.") == std::string_view::npos;
}

}  // namespace

bool may_be_calendar(std::string_view text) {
  std::vector<std::string> parts = split(text, " ");
  std::erase(parts, "");
  if (parts.empty()) return false;
  auto part = parts.begin();
  const auto take = [&](bool fits) { part += fits ? 1 : 0; };
  const auto left = [&] { return part != parts.end(); };
  if (is_word(in_small(*part)) || is_epoch(*part) || is_date_and_time(*part)) {
    ++part;
  } else {
    take(are_days(*part));
    if (left()) take(is_date(*part));
    if (left()) take(is_time(*part));
    if (part == parts.begin()) return false;
  }
  if (left()) take(is_zone(*part));
  return !left();
}

}  // namespace imunoise::config
