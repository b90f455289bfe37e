#include "recording/import/preflight/clock.h"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "recording/import/table/time_names.h"

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
constexpr double kDay = 86400.0;      // s
constexpr double kTick = 1e-7;        // s
constexpr double kUsualRate = 200.0;  // Hz, of inertial sensors
constexpr double kHighestRate = 1e6;  // Hz: no such sensor is as fast
constexpr double kSlowRate = 10.0;    // Hz: hardly any is as slow

constexpr double kXsensTick = 1e-4;  // s

std::string_view name_of(double seconds) {
  if (seconds == kXsensTick) return "tenths of milliseconds";
  if (seconds == 60.0) return "minutes";
  if (seconds == 3600.0) return "hours";
  if (seconds == kDay) return "days";
  if (seconds == kTick) return "units of 100 ns";
  const auto* const found =
      std::find_if(kTimeUnits.begin(), kTimeUnits.end(),
                   [&](const TimeUnit& one) { return one.seconds == seconds; });
  return found == kTimeUnits.end() ? "numbers" : found->name;
}

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

constexpr std::size_t kMostSteps = 16384;  // that are looked at
constexpr double kLonger = 1.75;  // of a step: rounded stamps of 2 and 3 grains are no loss beside

// The step of samples between which none is lost, where most steps show it.
struct UsualStep {
  double mean = 0.0;
  double scatter = 0.0;
  double error = 0.0;  // of the mean
};

bool are_multiples(const Clock& clock, std::size_t stride, double grain) {
  for (std::size_t i = 0; i < clock.size(); i += stride) {
    const double at = clock.at(i) / grain;
    if (!(std::abs(at - std::round(at)) < 1e-3 + 1e-12 * std::abs(at))) return false;
  }
  return true;
}

// The power of a base (s) that all stamps that are looked at are multiples of; 1e-9 at least.
double grain_of(const Clock& clock, std::size_t stride, double base) {
  constexpr double kFinest = 1e-9;
  double grain = 1.0;
  while (grain > kFinest && !are_multiples(clock, stride, grain)) grain /= base;
  return grain;
}

// Whether longer steps come at random, as losses do: their distances scatter as much as they are
// long. Those of coarse stamps come in turn.
bool come_at_random(const Clock& clock, double step) {
  constexpr std::size_t kFewest = 10;
  constexpr double kRandom = 0.5;  // of the 1 of a geometric distribution
  double count = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  std::size_t before = 0;
  for (std::size_t i = 1; i < std::min(clock.size(), kMostSteps); ++i) {
    if (!(clock.step(i) > kLonger * step)) continue;
    const auto distance = static_cast<double>(i - before);
    before = i;
    count += 1.0;
    sum += distance;
    squares += distance * distance;
  }
  if (count < static_cast<double>(kFewest)) return false;
  const double mean = sum / count;
  return squares / count - mean * mean > kRandom * mean * (mean - 1.0);
}

// Nearly all steps are one to four times one that is the most frequent: the longer ones are lost
// samples. Nothing where stamps come in bursts, or are so coarse that they show steps of
// their own.
std::optional<UsualStep> usual_step(const Clock& clock) {
  constexpr double kMultiples = 0.95;  // of the steps, at least
  constexpr double kSingle = 0.5;
  constexpr double kNear = 0.35;      // of a step
  constexpr double kMost = 4.0;       // multiples
  constexpr double kFineGrain = 4.0;  // grains of the stamps in a step, at least,
  constexpr double kFastest = 5e-3;   // s, unless the step is longer, and the rate not customary:
  constexpr double kCustomary = 5.0;  // Hz, or a multiple
  constexpr double kWhole = 5e-4;     // of it
  const std::size_t stride = std::max<std::size_t>(1, (clock.size() - 1) / kMostSteps);
  std::vector<double> some;
  for (std::size_t i = 1; i < clock.size(); i += stride) some.push_back(clock.step(i));
  const double median = median_of(std::move(some));
  if (!(median > 0.0)) return std::nullopt;
  const double decimal = grain_of(clock, stride, 10.0);
  const double binary = grain_of(clock, stride, 2.0);  // of short floating-point numbers
  const bool coarse = median < kFineGrain * std::max(decimal, binary);
  const double rate = 1.0 / clock.period();
  const double customary = kCustomary * std::round(rate / kCustomary);
  const bool whole = std::abs(rate - customary) < kWhole * rate;
  const bool own = median < kFastest || whole || binary > decimal;
  if (coarse && own && !come_at_random(clock, median)) return std::nullopt;
  double sum = 0.0;
  double squares = 0.0;
  double count = 0.0;
  double multiples = 0.0;
  // Every step counts: rounded stamps repeat a pattern, and a stride may see only one of its steps.
  for (std::size_t i = 1; i < clock.size(); ++i) {
    const double step = clock.step(i);
    const double off = step - median * std::clamp(std::round(step / median), 1.0, kMost);
    if (std::abs(off) > kNear * median) continue;
    multiples += 1.0;
    if (step > kLonger * median) continue;
    sum += off;
    squares += off * off;
    count += 1.0;
  }
  const auto all = static_cast<double>(clock.size() - 1);
  if (multiples < kMultiples * all || count < kSingle * all || count < 2.0) return std::nullopt;
  const double mean = sum / count;
  const double scatter = std::sqrt(std::max(0.0, squares / count - mean * mean));
  return UsualStep{median + mean, scatter, scatter / std::sqrt(count)};
}

// Mean over blocks of 64 steps, of those near the median block: a gap spoils its own block only,
// and bursts average out.
double period_of_blocks(const Clock& clock) {
  const std::size_t lag = std::clamp<std::size_t>((clock.size() - 1) / 8, 1, 64);
  const std::size_t blocks = (clock.size() - 1) / lag;
  const std::size_t stride = std::max<std::size_t>(1, blocks / kMostSteps);
  std::vector<double> steps;
  for (std::size_t b = 0; b < blocks; b += stride)
    steps.push_back((clock.at((b + 1) * lag) - clock.at(b * lag)) / static_cast<double>(lag));
  const double median = median_of(steps);
  double sum = 0.0;
  std::size_t count = 0;
  for (const double step : steps) {
    if (std::abs(step - median) > 0.25 * std::abs(median)) continue;
    sum += step;
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : median;
}

constexpr std::string_view kBySteps = " (by their steps)";

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
  // Days since 1900 (spreadsheets) or since the year 0 (MATLAB), of this century.
  const bool days = (first > 3e4 && first < 8e4) || (first > 7.2e5 && first < 7.8e5);
  if (days && step * kHighestRate < 1.0) return {kDay, " (by their values)"};
  // 100 ns since the year 1 (.NET) or since 1601 (Windows), of this century.
  const bool ticks = (first > 6.3e17 && first < 6.7e17) || (first > 1.25e17 && first < 1.6e17);
  if (ticks && step * kTick * kHighestRate > 1.0) return {kTick, " (by their values)"};
  if (step <= 1.0) return {1.0, kBySteps};
  const TimeUnit* best = &kTimeUnits[1];
  const auto distance = [&](const TimeUnit& unit) {
    return std::abs(std::log(1.0 / (step * unit.seconds) / kUsualRate));
  };
  for (const TimeUnit& unit : kTimeUnits) {
    if (distance(unit) < distance(*best)) best = &unit;
  }
  return {best->seconds, kBySteps};
}

// Numbers that rise by one may be seconds, or milliseconds of a sensor at 1 kHz.
std::string doubt_of(const JudgedUnit& judged, double step) {
  constexpr double kFiner = 1e-3;
  const double rate = 1.0 / (step * judged.seconds);
  if (judged.how != kBySteps || !(rate < kSlowRate) || judged.seconds * kFiner < 1e-9) return "";
  return fmt::format(
      "the unit of the times is a guess: in {}, the rate is {:.4g} Hz; in {}, it is {:.4g} Hz. "
      "State "
      "it with --time-unit",
      name_of(judged.seconds), rate, name_of(judged.seconds * kFiner), rate / kFiner);
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
  const double step = period_of_blocks(out);
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
    // Xsens names the counter of its DOT sensors, which counts microseconds, as those of its MTi.
    const bool by_name = column.unit.empty() && judged.seconds == kXsensTick;
    if (by_name && step * kXsensTick * kSlowRate > 1.0) {
      judged = {1e-6, kBySteps};
      out.doubt_ = fmt::format(
          "the unit of the times is a guess: in microseconds (Xsens DOT), the rate is {:.4g} Hz; "
          "in "
          "tenths of milliseconds (MTi), {:.4g} Hz. If the latter is right, pass it with --rate",
          1.0 / (step * 1e-6), 1.0 / (step * kXsensTick));
    }
  } else {
    judged = judge_unit(first, step);
    if (out.whole_ != nullptr) out.doubt_ = doubt_of(judged, step);
  }
  out.unit_ = judged.seconds;
  out.rounding_ *= judged.seconds;
  out.period_ = step * judged.seconds;
  if (!(out.period_ * kHighestRate > 1.0))
    return fail(
        fmt::format("{}: its steps are {:.3g} s, shorter than those of any inertial sensor; give "
                    "--time-unit, or --rate HZ to ignore them",
                    place, out.period_));
  out.follow_single_steps();
  out.said_ =
      fmt::format("column {}, {}{}", column.name,
                  column.calendar ? "dates and times" : name_of(judged.seconds), judged.how);
  if (!column.said.empty()) out.said_ = column.said;
  return out;
}

void Clock::follow_single_steps() {
  constexpr double kEven = 0.1;
  constexpr double kBeyondChance = 5.0;
  const auto usual = usual_step(*this);
  if (!usual) return;
  even_ = usual->scatter < kEven * usual->mean;
  // Where blocks are longer than steps, each has lost samples.
  loses_ = period_ > usual->mean * 1.0001 + kBeyondChance * usual->error;
  if (loses_) period_ = usual->mean;
}

}  // namespace imunoise::recording
