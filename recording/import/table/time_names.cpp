#include "recording/import/table/time_names.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <vector>

#include "recording/import/table/words.h"

namespace imunoise::recording {
namespace {

struct Suffix {
  std::string_view text;
  double seconds;
};
constexpr std::array kTimeSuffixes = {
    Suffix{"s", 1.0},   Suffix{"sec", 1.0},   Suffix{"secs", 1.0},   Suffix{"seconds", 1.0},
    Suffix{"ms", 1e-3}, Suffix{"msec", 1e-3}, Suffix{"us", 1e-6},    Suffix{"usec", 1e-6},
    Suffix{"ns", 1e-9}, Suffix{"nsec", 1e-9}, Suffix{"nsecs", 1e-9}, Suffix{"nanosec", 1e-9}};

// Only where they are said to be units: t_min may be a minimum.
constexpr std::array kLongTimes = {Suffix{"min", 60.0},          Suffix{"minutes", 60.0},
                                   Suffix{"h", 3600.0},          Suffix{"hours", 3600.0},
                                   Suffix{"milliseconds", 1e-3}, Suffix{"microseconds", 1e-6},
                                   Suffix{"nanoseconds", 1e-9},  Suffix{"days", 86400.0}};

// Times whose name is their unit: those of Arduino, of Xsens devices, and of ROS, which has
// nanoseconds beside them.
constexpr std::array kTimesOfOneUnit = {
    Suffix{"millis", 1e-3}, Suffix{"micros", 1e-6}, Suffix{"sampletimefine", 1e-4},
    Suffix{"sec", 1.0},     Suffix{"secs", 1.0},    Suffix{"seconds", 1.0},
    Suffix{"nsec", 1e-9},   Suffix{"nsecs", 1e-9},  Suffix{"nanosec", 1e-9}};

constexpr std::array<std::string_view, 26> kTimeNames = {"t",
                                                         "time",
                                                         "timestamp",
                                                         "timestamps",
                                                         "stamp",
                                                         "headerstamp",
                                                         "fieldheaderstamp",
                                                         "rosbagtimestamp",
                                                         "timestampsample",
                                                         "utctime",
                                                         "timeutc",
                                                         "utc",
                                                         "datetime",
                                                         "localtime",
                                                         "systemtime",
                                                         "sensortime",
                                                         "loggingtime",
                                                         "hosttime",
                                                         "elapsed",
                                                         "elapsedtime",
                                                         "timesincestart",
                                                         "timesincestartin",
                                                         "secondselapsed",
                                                         "tow",
                                                         "gpstow",
                                                         "towgps"};

const Suffix* time_of_one_unit(std::string_view text) {
  const auto* const found = std::find_if(kTimesOfOneUnit.begin(), kTimesOfOneUnit.end(),
                                         [&](const Suffix& one) { return one.text == text; });
  return found == kTimesOfOneUnit.end() ? nullptr : found;
}

// The name without its last word, if that is a unit of time of this length.
std::optional<std::string> stem_without(std::string_view name, double seconds) {
  std::vector<std::string> words = words_of(name);
  if (words.empty()) return std::nullopt;
  const std::string last = std::move(words.back());
  words.pop_back();
  const bool unit = std::any_of(kTimeSuffixes.begin(), kTimeSuffixes.end(), [&](const auto& one) {
    return one.text == last && one.seconds == seconds;
  });
  return unit ? std::optional(joined_words(words)) : std::nullopt;
}

}  // namespace

std::optional<std::string> stem_of_seconds(std::string_view name) {
  return stem_without(name, 1.0);
}
std::optional<std::string> stem_of_nanoseconds(std::string_view name) {
  return stem_without(name, 1e-9);
}

bool is_time_name(std::string_view name) {
  std::vector<std::string> words = words_of(name);
  const auto known = [&] {
    const std::string text = joined_words(words);
    const bool listed = std::find(kTimeNames.begin(), kTimeNames.end(), text) != kTimeNames.end();
    return listed || time_of_one_unit(text) != nullptr;
  };
  if (words.empty()) return false;
  if (known()) return true;
  const bool suffixed = std::any_of(kTimeSuffixes.begin(), kTimeSuffixes.end(),
                                    [&](const Suffix& one) { return one.text == words.back(); });
  words.pop_back();
  return suffixed && known();
}

Result<std::optional<double>> time_unit(std::string_view name, std::string_view unit) {
  const auto seconds = [](std::string_view text) -> std::optional<double> {
    for (const Suffix& one : kTimeSuffixes) {
      if (one.text == text) return one.seconds;
    }
    return std::nullopt;
  };
  if (unit.empty()) {
    const std::vector<std::string> words = words_of(name);
    if (const Suffix* const known = time_of_one_unit(joined_words(words)))
      return std::optional(known->seconds);
    if (words.empty() || words.size() == 1) return std::optional<double>();
    return seconds(words.back() == "elapsed" ? words.front() : words.back());
  }
  unit = unit.substr(0, unit.find(" since "));  // "seconds since 2026-11-29" (CF conventions)
  if (unit == "µs" || unit == "μs") return std::optional(1e-6);
  if (const auto known = seconds(unit)) return known;
  for (const Suffix& one : kLongTimes) {
    if (one.text == unit) return std::optional(one.seconds);
  }
  return fail(fmt::format(
      "'{}' is not a unit of time that is known here (h, min, s, ms, us, ns); correct it, give "
      "--time-unit, or give --rate HZ to ignore the times",
      unit));
}

}  // namespace imunoise::recording
