#include "recording/import/preflight/clock.h"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "recording/import/table/names.h"

namespace imunoise::recording {
namespace {

struct TimeUnit {
  double seconds;
  std::string_view name;
};
constexpr std::array<TimeUnit, 4> kTimeUnits = {
    {{1.0, "seconds"}, {1e-3, "milliseconds"}, {1e-6, "microseconds"}, {1e-9, "nanoseconds"}}};

constexpr double kEarliest = 9e8;     // s since 1970: 1998
constexpr double kLatest = 4e9;       // 2096
constexpr double kUsualRate = 200.0;  // Hz, of inertial sensors

std::string_view name_of(double seconds) {
  if (seconds == 1e-4) return "tenths of milliseconds";
  const auto* const found =
      std::find_if(kTimeUnits.begin(), kTimeUnits.end(),
                   [&](const TimeUnit& one) { return one.seconds == seconds; });
  return found == kTimeUnits.end() ? "numbers" : found->name;
}

// Mean over blocks of 64 steps, of those near the median block: a gap spoils its own block only,
// and bursts average out.
double period_of(const Clock& clock) {
  constexpr std::size_t most = 16384;
  const std::size_t lag = std::clamp<std::size_t>((clock.size() - 1) / 8, 1, 64);
  const std::size_t blocks = (clock.size() - 1) / lag;
  const std::size_t stride = std::max<std::size_t>(1, blocks / most);
  std::vector<double> steps;
  for (std::size_t b = 0; b < blocks; b += stride)
    steps.push_back((clock.at((b + 1) * lag) - clock.at(b * lag)) / static_cast<double>(lag));
  auto sorted = steps;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  double sum = 0.0;
  std::size_t count = 0;
  for (const double step : steps) {
    if (std::abs(step - *middle) > 0.25 * std::abs(*middle)) continue;
    sum += step;
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : *middle;
}

struct JudgedUnit {
  double seconds;
  std::string_view how;
};

// From what the first stamp and the usual step are, in the column's own numbers.
JudgedUnit judge_unit(double first, double step) {
  for (const TimeUnit& unit : kTimeUnits) {
    const double since = first * unit.seconds;
    const double rate = 1.0 / (step * unit.seconds);
    if (since > kEarliest && since < kLatest && rate > 1e-3 && rate < 1e6)
      return {unit.seconds, " since 1970 (by their values)"};
  }
  if (step <= 1.0) return {1.0, " (by their steps)"};
  const TimeUnit* best = &kTimeUnits[1];
  const auto distance = [&](const TimeUnit& unit) {
    return std::abs(std::log(1.0 / (step * unit.seconds) / kUsualRate));
  };
  for (const TimeUnit& unit : kTimeUnits) {
    if (distance(unit) < distance(*best)) best = &unit;
  }
  return {best->seconds, " (by their steps)"};
}

}  // namespace

Result<Clock> Clock::read(const std::string& place, const TimeColumn& column,
                          std::optional<double> unit) {
  const Result<std::optional<double>> stated =
      unit || column.calendar ? std::optional<double>() : time_unit(column.name, column.unit);
  if (!stated) return fail(fmt::format("{}: {}", place, stated.error().message));
  Clock out;
  out.size_ = recording::size(column.stamps);
  if (out.size_ < 2) {
    return fail(
        fmt::format("{}: cannot derive the sampling rate from {} time stamps; pass --rate HZ",
                    place, out.size_));
  }
  double first = 0.0;
  double last = 0.0;
  if (const auto* const whole = std::get_if<std::vector<std::int64_t>>(&column.stamps)) {
    out.whole_ = whole->data();
    first = static_cast<double>(whole->front());
    out.rounding_ = 1.0;
  } else {
    const auto& numbers = std::get<std::vector<double>>(column.stamps);
    if (!std::all_of(numbers.begin(), numbers.end(), [](double one) { return std::isfinite(one); }))
      return fail(fmt::format("{}: a time is missing; give --rate HZ to ignore them", place));
    out.numbers_ = numbers.data();
    first = numbers.front();
    last = numbers.back();
    out.rounding_ =
        std::numeric_limits<double>::epsilon() * std::max(std::abs(first), std::abs(last));
  }
  const double step = period_of(out);
  if (!(step > 0.0) || !std::isfinite(step)) {
    return fail(fmt::format(
        "{}: shows no usable rate: the times do not rise; give --rate HZ to ignore them", place));
  }
  JudgedUnit judged{1.0, ""};
  if (column.calendar) {
    judged = {1e-9, ""};
  } else if (unit) {
    judged = {*unit, " (--time-unit)"};
  } else if (*stated) {
    judged = {**stated, ""};
  } else {
    judged = judge_unit(first, step);
  }
  out.unit_ = judged.seconds;
  out.rounding_ *= judged.seconds;
  out.period_ = step * judged.seconds;
  out.said_ =
      fmt::format("column {}, {}{}", column.name,
                  column.calendar ? "dates and times" : name_of(judged.seconds), judged.how);
  if (!column.said.empty()) out.said_ = column.said;
  return out;
}

}  // namespace imunoise::recording
