#include "study/figure/time_ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

#include "study/words/number.h"

namespace imunoise::figure {
namespace {

constexpr double kMinute = 60.0;
constexpr double kHour = 3600.0;
constexpr double kDay = 86400.0;
constexpr double kMonth = 30.4 * kDay;
constexpr double kMostDays = 10.0 * kDay;  // beyond, months are counted

// Beginnings of months, `every` of them apart, counted from the first January on.
std::vector<Tick> month_ticks(double low, double high, int every) {
  using std::chrono::sys_days;
  const auto first = std::chrono::floor<std::chrono::days>(
      std::chrono::sys_seconds(std::chrono::seconds(static_cast<std::int64_t>(low))));
  std::vector<Tick> out;
  for (std::chrono::year_month month =
           std::chrono::year_month_day(first).year() / std::chrono::January;
       ; month += std::chrono::months(every)) {
    const auto value = static_cast<double>(sys_days(month / 1).time_since_epoch().count()) * kDay;
    if (value > high) return out;
    if (value < low) continue;
    const int year = static_cast<int>(month.year());
    out.push_back({value, true,
                   every % 12 == 0
                       ? fmt::format("{}", year)
                       : fmt::format("{}-{:02}", year, static_cast<unsigned>(month.month()))});
  }
}

// Months from one tick to the next that are at least `least` seconds apart.
int month_step(double least) {
  const double months = least / kMonth;
  for (const int step : {1, 2, 3, 6}) {
    if (months <= step) return step;
  }
  return 12 * static_cast<int>(std::lround(std::max(1.0, round_step(months / 12.0))));
}

std::int64_t nanoseconds(double seconds) {
  return static_cast<std::int64_t>(std::llround(seconds)) * 1'000'000'000;
}

// Of a clock; seconds where they differ.
std::string moment(double seconds, double step) {
  const auto whole = std::llround(seconds);
  const auto in_day = (whole % 86400 + 86400) % 86400;
  const std::string minute = fmt::format("{:02}:{:02}", in_day / 3600, in_day / 60 % 60);
  return step < kMinute ? fmt::format("{}:{:02}", minute, in_day % 60) : minute;
}

}  // namespace

double round_step(double least) {
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  const double digit = least / decade;
  if (digit <= 1.0) return decade;
  if (digit <= 2.0) return 2.0 * decade;
  return digit <= 5.0 ? 5.0 * decade : 10.0 * decade;
}

double clock_step(double least) {
  if (least <= 1.0) return round_step(least);
  for (const double step : {2.0, 5.0, 10.0, 30.0, kMinute, 2 * kMinute, 5 * kMinute, 10 * kMinute,
                            30 * kMinute, kHour, 2 * kHour, 6 * kHour, 12 * kHour, kDay}) {
    if (least <= step) return step;
  }
  return kDay * round_step(least / kDay);
}

std::vector<Tick> time_ticks(double low, double high, double least) {
  if (least > kMostDays) return month_ticks(low, high, month_step(least));
  const double step = std::max(1.0, clock_step(least));
  std::vector<Tick> out;
  std::string before;
  for (double k = std::ceil(low / step); k * step <= high; k += 1.0) {
    std::string label = report::day(nanoseconds(k * step));
    if (step < kDay) {
      const bool same = label == before;
      before = label;
      label = same ? moment(k * step, step) : label + " " + moment(k * step, step);
    }
    out.push_back({k * step, true, std::move(label)});
  }
  return out;
}

}  // namespace imunoise::figure
