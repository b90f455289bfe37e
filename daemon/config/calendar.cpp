#include "daemon/config/calendar.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <string>
#include <vector>

namespace imunoise::config {
namespace {

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

// 1 for Monday; 0 for what is no day of the week.
std::size_t day_of(std::string_view text) {
  constexpr std::array<std::string_view, 7> kDays = {"monday", "tuesday",  "wednesday", "thursday",
                                                     "friday", "saturday", "sunday"};
  const std::string small = in_small(text);
  for (std::size_t i = 0; i < kDays.size(); ++i) {
    if (small == kDays[i] || small == kDays[i].substr(0, 3)) return i + 1;
  }
  return 0;
}

// "Mon", "Mon,Wed..Fri", "Mon-Fri", "Wed,"
bool are_days(std::string_view text) {
  if (text.ends_with(',')) text.remove_suffix(1);
  for (const std::string& range : split(text, ",")) {
    const std::size_t dots = range.find("..");
    const std::size_t mark = dots == std::string::npos ? range.find('-') : dots;
    const std::size_t first = day_of(range.substr(0, mark));
    const std::size_t width = dots == std::string::npos ? 1 : 2;
    const std::size_t last = mark == std::string::npos ? first : day_of(range.substr(mark + width));
    if (first == 0 || last < first) return false;
  }
  return true;
}

// A number up to `most`, taken off the front.
bool take_number(std::string_view& text, int most, bool decimals) {
  int value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || value > most || text.front() == '-') return false;
  text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
  if (!decimals || !text.starts_with('.') || text.starts_with("..")) return true;
  text.remove_prefix(1);
  const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
  text.remove_prefix(digits);
  return digits > 0;
}

// "*", "1,5", "8..17", "0/15"
bool is_field(std::string_view text, int most, bool decimals = false) {
  if (text == "*") return true;
  for (const std::string& item : split(text, ",")) {
    std::string_view rest = item;
    if (rest.starts_with('*')) {
      rest.remove_prefix(1);
    } else {
      if (!take_number(rest, most, decimals)) return false;
      if (rest.starts_with("..")) {
        rest.remove_prefix(2);
        if (!take_number(rest, most, decimals)) return false;
      }
    }
    if (rest.starts_with('/')) {
      rest.remove_prefix(1);
      if (!take_number(rest, most, decimals)) return false;
    }
    if (!rest.empty()) return false;
  }
  return true;
}

bool is_date(std::string_view text) {
  const std::vector<std::string> fields = split(text, "-~");
  if (fields.size() < 2 || fields.size() > 3) return false;
  const std::size_t month = fields.size() - 2;
  return is_field(fields.back(), 31) && is_field(fields[month], 12) &&
         (month == 0 || is_field(fields[0], 9999));
}

bool is_time(std::string_view text) {
  const std::vector<std::string> fields = split(text, ":");
  if (fields.size() < 2 || fields.size() > 3) return false;
  return is_field(fields[0], 23) && is_field(fields[1], 59) &&
         (fields.size() == 2 || is_field(fields[2], 59, true));
}

// "UTC", "Europe/Zurich": systemd knows which there are.
bool is_zone(std::string_view text) {
  return std::isalpha(static_cast<unsigned char>(text.front())) != 0 && day_of(text) == 0 &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) {
           const bool mark =
               std::string_view("/_+-").find(static_cast<char>(c)) != std::string_view::npos;
           return c < 128 && (std::isalnum(c) != 0 || mark);
         });
}

bool is_word(const std::string& text) {
  constexpr std::array<std::string_view, 13> kWords = {
      "minutely", "hourly",     "daily",        "weekly",        "monthly",
      "yearly",   "quarterly",  "semiannually", "semi-annually", "annually",
      "anually",  "biannually", "bi-annually"};
  return std::find(kWords.begin(), kWords.end(), text) != kWords.end();
}

// "@1395716396": seconds since 1970
bool is_epoch(std::string_view text) {
  return text.size() > 1 && text.front() == '@' &&
         text.substr(1).find_first_not_of("0123456789") == std::string_view::npos;
}

}  // namespace

bool may_be_calendar(std::string_view text) {
  std::vector<std::string> parts = split(text, " ");
  std::erase(parts, "");
  if (parts.empty()) return false;
  auto part = parts.begin();
  const auto take = [&](bool fits) { part += fits ? 1 : 0; };
  const auto left = [&] { return part != parts.end(); };
  if (is_word(in_small(*part)) || is_epoch(*part)) {
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
