#include "recording/import/preflight/pace.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace imunoise::recording {
namespace {

constexpr std::size_t kMedian = 8;
constexpr std::size_t kMean = 64;

struct Side {
  double median = 0.0;
  double mean = 0.0;
  double spread = 0.0;
};

// Lateness (s) of samples [begin, end) against a clock that ticks from sample `about`.
Side side_of(const Clock& clock, double period, std::size_t about, std::size_t begin,
             std::size_t end, bool near_end) {
  std::array<double, kMean> late;
  const std::size_t count = end - begin;
  for (std::size_t i = 0; i < count; ++i) {
    const auto ticks = static_cast<double>(begin + i) - static_cast<double>(about);
    late[i] = clock.at(begin + i) - ticks * period;
  }
  Side out;
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) sum += late[i];
  out.mean = sum / static_cast<double>(count);
  const auto [low, high] = std::minmax_element(late.begin(), late.begin() + count);
  out.spread = *high - *low;
  const std::size_t few = std::min(count, kMedian);
  auto* const from = near_end ? late.data() + count - few : late.data();
  std::nth_element(from, from + few / 2, from + few);
  out.median = from[few / 2];
  return out;
}

struct Shift {
  double seconds = 0.0;  // 0: the pace goes on
  double mean = 0.0;
  bool clean = false;
};

Shift shift_at(const Clock& clock, double period, std::size_t at) {
  const std::size_t begin = at > kMean ? at - kMean : 0;
  const std::size_t end = std::min(clock.size(), at + kMean);
  const Side before = side_of(clock, period, at, begin, at, true);
  const Side after = side_of(clock, period, at, at, end, false);
  const double median = after.median - before.median;
  const double mean = after.mean - before.mean;
  const double step = clock.step(at) - period;
  // Beside a border the means cover no whole bursts.
  const bool whole = at - begin == kMean && end - at == kMean;
  const double least = 0.5 * period + (whole ? 0.0 : std::min(before.spread, after.spread));
  const bool same_way = (median > 0.0) == (mean > 0.0);
  if (!same_way || std::abs(median) < least || std::abs(mean) < least) return {};
  const bool clean = std::abs(median - step) < 0.5 * period;
  return {clean ? median : mean, mean, clean};
}

// A stall: rows come late, and then so many at once that the old pace is met again.
bool is_made_up_for(const Clock& clock, double period, std::size_t at) {
  constexpr std::size_t kSpare = 16;
  constexpr double kCatchesUp = 0.25;  // periods a row, at least
  const double begun = clock.at(at - 1);
  const double stalled = clock.step(at) - period;
  if (!(stalled > 0.0)) return false;
  std::array<double, kMedian> late;
  for (std::size_t first = at + 1; first + kMedian <= clock.size(); ++first) {
    for (std::size_t i = 0; i < kMedian; ++i)
      late[i] = clock.at(first + i) - begun - static_cast<double>(first + i + 1 - at) * period;
    std::nth_element(late.begin(), late.begin() + kMedian / 2, late.end());
    const double still = late[kMedian / 2];
    if (still < 0.5 * period) return true;
    const std::size_t rows = first - at;
    if (rows > kSpare && still > stalled - kCatchesUp * period * static_cast<double>(rows))
      return false;
  }
  return false;
}

// The stamp before this one came early: the step to it was short, and both steps are two periods.
bool came_early(const Clock& clock, double period, std::size_t at) {
  if (at < 2 || clock.step(at - 1) > 0.5 * period) return false;
  const bool late = at > 2 && clock.step(at - 2) > 1.5 * period;  // before the short step
  const double both = clock.at(at) - clock.at(at - 2);
  return !late && std::abs(both - 2.0 * period) < 0.5 * period;
}

// Even stamps show each lost sample, however near the next loss is; a late stamp is made up for by
// the next step, an early one makes up for its own.
std::optional<Shift> lost_at(const Clock& clock, double period, std::size_t at) {
  if (!clock.even() || clock.step(at) < 1.5 * period) return std::nullopt;
  const bool late = at + 1 < clock.size() && clock.step(at + 1) < 0.5 * period;
  if (late || came_early(clock, period, at)) return std::nullopt;
  const double seconds = clock.step(at) - period;
  return Shift{seconds, seconds, true};
}

// Whether most of the steps up to `end` are their mean, within a fifth and much closer than another
// period is: blocks with losses are not.
bool come_evenly(const Clock& clock, std::size_t begin, std::size_t end, double mean,
                 double period) {
  const double reach = std::min(0.2 * mean, 0.5 * std::abs(mean - period));
  std::size_t near = 0;
  for (std::size_t i = begin + 1; i <= end; ++i)
    near += std::abs(clock.step(i) - mean) < reach ? 1U : 0U;
  return 2 * near > end - begin;
}

// A recorder that was set to another rate goes on for thousands of samples. Blocks with losses or
// bursts do not come evenly.
std::vector<OtherPace> other_paces(const Clock& clock, double period) {
  constexpr double kOther = 1.06;
  constexpr double kSame = 0.03;
  constexpr std::size_t kFewestBlocks = 16;
  std::vector<OtherPace> out;
  const std::size_t blocks = (clock.size() - 1) / kMean;
  std::size_t first = 0;
  std::size_t run = 0;
  double sum = 0.0;
  const auto end_run = [&](std::size_t block) {
    if (run >= kFewestBlocks) {
      // The pace changes within a block.
      const std::size_t begin = first > 0 ? (first - 1) * kMean : 0;
      out.push_back(
          {begin, std::min((block + 1) * kMean, clock.size()), sum / static_cast<double>(run)});
    }
    run = 0;
    sum = 0.0;
  };
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t begin = b * kMean;
    const double mean = (clock.at(begin + kMean) - clock.at(begin)) / static_cast<double>(kMean);
    const bool other = mean > 0.0 && (mean > kOther * period || kOther * mean < period) &&
                       come_evenly(clock, begin, begin + kMean, mean, period);
    const bool goes_on = run > 0 && std::abs(mean * static_cast<double>(run) / sum - 1.0) < kSame;
    if (!other || !goes_on) end_run(b);
    if (!other) continue;
    if (run++ == 0) first = b;
    sum += mean;
  }
  end_run(blocks);
  return out;
}

struct Candidate {
  std::size_t at;
  Shift shift;
};

// Where stamps come in bursts, every burst beside a gap shows a part of it: the largest counts.
void add_leap(const Candidate& one, std::vector<Candidate>& leaps) {
  if (!leaps.empty() && one.at - leaps.back().at < kMean && !one.shift.clean &&
      !leaps.back().shift.clean) {
    if (std::abs(one.shift.mean) > std::abs(leaps.back().shift.mean)) leaps.back() = one;
    return;
  }
  leaps.push_back(one);
}

}  // namespace

std::vector<std::size_t> logged_twice(const Clock& clock,
                                      const std::function<bool(std::size_t)>& same) {
  constexpr double kNearlyAll = 0.9;
  std::vector<std::size_t> out;
  std::size_t same_time = 0;
  for (std::size_t i = 1; i < clock.size(); ++i) {
    if (clock.step(i) != 0.0) continue;
    ++same_time;
    if (same(i)) out.push_back(i);
  }
  if (static_cast<double>(out.size()) < kNearlyAll * static_cast<double>(same_time)) return {};
  return out;
}

std::string words_of(const OtherPace& one, const Clock& clock, double period) {
  return fmt::format(
      "from {:.6g} to {:.6g} s, samples come at {:.4g} Hz, most others at {:.4g} Hz: left out; put "
      "them into a file of their own",
      clock.at(one.begin), clock.at(one.end - 1), 1.0 / one.period, 1.0 / period);
}

Pace pace_of(const Clock& clock, const std::function<bool(std::size_t)>& same) {
  Pace out;
  out.period = clock.period();
  out.others = other_paces(clock, out.period);
  const std::size_t count = clock.size();
  // Rows that step from one of the same pace.
  std::vector<bool> steps(count, true);
  steps[0] = false;
  for (const OtherPace& one : out.others) {
    const std::size_t end = std::min(one.end + 1, count);
    std::fill(steps.begin() + static_cast<std::ptrdiff_t>(one.begin),
              steps.begin() + static_cast<std::ptrdiff_t>(end), false);
  }
  std::vector<Candidate> leaps;
  for (std::size_t i = 1; i < count; ++i) {
    if (!steps[i]) continue;
    const double step = clock.step(i);
    const bool twice = step == 0.0 && same(i);
    if (step >= 0.0 && step < 1.5 * out.period && !twice) continue;
    const auto lost = lost_at(clock, out.period, i);
    Shift shift = lost ? *lost : shift_at(clock, out.period, i);
    if (shift.seconds > 0.0 && is_made_up_for(clock, out.period, i)) shift = {};
    if (twice) {
      if (shift.seconds < 0.0) out.twice.push_back(i);
    } else if (shift.seconds != 0.0) {
      add_leap({i, shift}, leaps);
    } else if (step < 0.0) {
      ++out.backwards;
    }
  }
  for (const Candidate& one : leaps) {
    out.leaps.push_back({one.at, one.shift.seconds});
    steps[one.at] = false;
  }
  std::size_t number = 0;
  for (std::size_t i = 1; i < count; ++i) {
    if (!steps[i]) continue;
    // Between two rows of a stretch: the first of these begins it.
    std::size_t end = i;
    while (end + 1 < count && steps[end + 1]) ++end;
    out.span += clock.at(end) - clock.at(i - 1);
    number += end - i + 1;
    i = end;
  }
  // Where samples are lost throughout, a stretch may still hold a loss.
  if (number > 0 && out.span > 0.0 && !clock.loses())
    out.period = out.span / static_cast<double>(number);
  for (std::size_t l = 0; l < leaps.size(); ++l) {
    if (leaps[l].shift.clean) out.leaps[l].seconds = clock.step(leaps[l].at) - out.period;
  }
  double squares = 0.0;
  for (std::size_t i = 1; i < count; ++i) {
    if (!steps[i]) continue;
    const double off = clock.step(i) - out.period;
    out.scatter = std::max(out.scatter, std::abs(off));
    squares += off * off;
  }
  out.jitter =
      std::sqrt(0.5 * squares / static_cast<double>(std::max<std::size_t>(1, number))) / out.period;
  return out;
}

}  // namespace imunoise::recording
