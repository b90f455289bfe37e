#include "core/integrity/integrity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "core/integrity/interpolation.h"
#include "core/support/neighbour_steps.h"

namespace imunoise {
namespace {

// What a recording of values on a grid looks like, in steps of that grid.
struct Codes {
  double step = 0.0;              // smallest difference between two values that occur
  double spread = 0.0;            // standard deviation of the difference of neighbours
  double apart = 0.0;             // and of samples kApart from each other
  std::size_t distinct = 0;       // values that occur, counted up to kMany
  std::size_t repeats = 0;        // samples equal to the one before
  std::size_t lowest = 0;         // samples at the smallest value
  std::size_t highest = 0;        // at the largest
  std::size_t below_highest = 0;  // at the value next to it
  std::size_t above_lowest = 0;
  std::size_t missing = 0;  // codes that never occur between two that often do
  double missed = 0.0;      // samples that these would have
};

constexpr std::size_t kMany = 100'000;  // distinct values: no grid worth the name

// Samples so far apart are compared to see how often codes meet by chance: no packet is so long.
constexpr std::size_t kNearest = 16;
constexpr std::size_t kFurthest = 31;

constexpr double kMostAlike = 0.98;  // chance of a repeat that is believed at most

// Noise that passed a filter changes little from one sample to the next; over so many it does.
constexpr std::size_t kApart = 64;

constexpr std::size_t kPile = 5;  // samples at an end of the range that are no chance

// Root mean square difference of samples so far apart; pairs with a certain value are left out.
double difference_at(const Signal& signal, std::size_t lag, std::optional<double> without = {}) {
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t t = lag; t < signal.size(); ++t) {
    const double earlier = signal.value(t - lag);
    const double later = signal.value(t);
    if (earlier == without || later == without) continue;
    squares += (later - earlier) * (later - earlier);
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(squares / count) : INFINITY;
}

// Differences of neighbours, and samples at the extremes, which values without a grid have as well.
Codes codes_without_grid(const Signal& signal) {
  Codes out;
  double smallest = signal.value(0);
  double largest = smallest;
  double before = smallest;
  double squares = 0.0;
  for (std::size_t t = 0; t < signal.size(); ++t) {
    const double value = signal.value(t);
    if (value < smallest) out.lowest = 0;
    if (value > largest) out.highest = 0;
    smallest = std::min(smallest, value);
    largest = std::max(largest, value);
    out.lowest += value == smallest ? 1 : 0;
    out.highest += value == largest ? 1 : 0;
    const double difference = value - before;
    squares += difference * difference;
    out.repeats += t > 0 && difference == 0.0 ? 1 : 0;
    before = value;
  }
  out.spread = std::sqrt(squares / static_cast<double>(signal.size()));
  out.apart = difference_at(signal, std::min(kApart, signal.size() / 4));
  out.distinct = kMany;
  return out;
}

struct Occurrence {
  double value = 0.0;
  std::size_t count = 0;
};

// How often each value occurs, rising; empty where kMany do.
std::vector<Occurrence> occurrences(const Signal& signal) {
  std::unordered_map<double, std::size_t> counts(1024);
  for (std::size_t t = 0; t < signal.size(); ++t) {
    ++counts[signal.value(t)];
    if (counts.size() >= kMany) return {};
  }
  std::vector<Occurrence> out;
  for (const auto& [value, count] : counts) out.push_back({value, count});
  std::sort(out.begin(), out.end(),
            [](const Occurrence& a, const Occurrence& b) { return a.value < b.value; });
  return out;
}

double noise_in_steps(const Codes& codes) {
  const double change = std::max(codes.spread, codes.apart);
  return NeighbourSteps{codes.step, change * change}.noise_in_steps();
}

// What changes from one sample to the next, in steps.
double change_in_steps(const Codes& codes) {
  return NeighbourSteps{codes.step, codes.spread * codes.spread}.noise_in_steps();
}

// Neighbours mostly share their code: to stand still is what such a series does.
bool stands_still(const Codes& codes) { return change_in_steps(codes) < 0.6; }

// Less noise makes few codes, and the error of rounding depends on where between two the mean lies:
// it is no longer white noise of step²/12. Nor is it where the output creeps from code to code.
bool is_coarse(const Codes& codes) {
  return noise_in_steps(codes) < 0.6 || change_in_steps(codes) < 0.1;
}

// Codes that a converter never gives. The density of noise that is wider than a step is concave in
// its logarithm from one code to the next: a code has at least the geometric mean of its
// neighbours' samples, and none at all of so many once in 10^10.
void add_missing_codes(const std::vector<Occurrence>& all, Codes& to) {
  constexpr double kFewest = 25.0;  // samples
  for (std::size_t i = 1; i < all.size(); ++i) {
    const double gap = (all[i].value - all[i - 1].value) / to.step;
    const double expected =
        std::sqrt(static_cast<double>(all[i].count) * static_cast<double>(all[i - 1].count));
    if (std::lround(gap) != 2 || expected < kFewest) continue;
    ++to.missing;
    to.missed += expected;
  }
}

Codes codes_of(const Signal& signal) {
  Codes out = codes_without_grid(signal);
  // Where next to nothing occurs twice, a grid would tell nothing.
  if (out.repeats < 2 && out.lowest < kPile && out.highest < kPile) return out;
  const std::vector<Occurrence> all = occurrences(signal);
  if (all.empty()) return out;
  out.distinct = all.size();
  if (all.size() < 2) return out;
  out.step = INFINITY;
  for (std::size_t i = 1; i < all.size(); ++i)
    out.step = std::min(out.step, all[i].value - all[i - 1].value);
  out.above_lowest = all[1].count;
  out.below_highest = all[all.size() - 2].count;
  if (!is_coarse(out)) add_missing_codes(all, out);
  return out;
}

constexpr std::size_t kFewestStuck = 8;  // samples

// A run of L equal samples is expected n·same^(L-1) times.
bool never_so_long(std::size_t run, double n, double same) {
  constexpr double kNever = 1e-6;
  return run >= kFewestStuck &&
         std::log(n) + (static_cast<double>(run) - 1.0) * std::log(same) < std::log(kNever);
}

std::vector<StuckRun> long_runs(const Signal& signal) {
  const std::size_t n = signal.size();
  std::vector<StuckRun> out;
  for (std::size_t begin = 0; begin < n;) {
    std::size_t end = begin + 1;
    const double value = signal.value(begin);
    while (end < n && signal.value(end) == value) ++end;
    if (end - begin >= kFewestStuck) out.push_back({begin, end - begin});
    begin = end;
  }
  return out;
}

// Chance that a sound sample equals the one before it: samples that lie some apart are no
// duplicates, and share their codes as often, whatever the step, the decimals that were printed and
// the codes that are missing. Where noise is correlated neighbours lie nearer to each other: the
// density of their difference at zero is larger as its deviation is smaller. Left out are long runs
// of one value, and the values at the ends of the range that samples were cut to.
double chance_of_repeat(const Signal& signal, const std::vector<StuckRun>& runs,
                        const std::vector<double>& ends) {
  std::array<double, kFurthest + 1> recent;
  recent.fill(NAN);
  double near = 0.0;
  double far = 0.0;
  std::size_t near_pairs = 0;
  std::size_t far_pairs = 0;
  std::size_t equal = 0;
  auto run = runs.begin();
  for (std::size_t t = 0; t < signal.size(); ++t) {
    while (run != runs.end() && t >= run->first + run->count) ++run;
    const double value = signal.value(t);
    const bool left_out = (run != runs.end() && t >= run->first) ||
                          std::find(ends.begin(), ends.end(), value) != ends.end();
    const auto before = [&](std::size_t lag) {
      return recent[(t + recent.size() - lag) % recent.size()];
    };
    if (!left_out && !std::isnan(before(1))) {
      near += (value - before(1)) * (value - before(1));
      ++near_pairs;
    }
    for (std::size_t lag = kNearest; !left_out && lag <= kFurthest; ++lag) {
      const double difference = value - before(lag);
      if (std::isnan(difference)) continue;
      far += difference * difference;
      ++far_pairs;
      equal += difference == 0.0 ? 1 : 0;
    }
    recent[t % recent.size()] = left_out ? NAN : value;
  }
  if (equal == 0 || near_pairs == 0 || !(near > 0.0)) return 0.0;
  const double nearer =
      std::sqrt(far / static_cast<double>(far_pairs) / (near / static_cast<double>(near_pairs)));
  return std::min(kMostAlike, nearer * static_cast<double>(equal) / static_cast<double>(far_pairs));
}

// Leaves the runs that noise of these codes never makes. Where the noise is smaller than the step,
// long runs are most of the samples, and tell nothing of the others.
void drop_likely(const Signal& signal, const Codes& codes, std::vector<StuckRun>& runs) {
  if (runs.empty()) return;
  const double same = stands_still(codes) ? kMostAlike : chance_of_repeat(signal, runs, {});
  std::erase_if(runs, [&](const StuckRun& run) {
    return !never_so_long(run.count, static_cast<double>(signal.size()), same);
  });
}

// Samples that repeat the one before, but for those of an output that stands still.
std::vector<WrongSample> repeats_of(const Signal& signal, const std::vector<StuckRun>& stuck) {
  std::vector<WrongSample> out;
  auto run = stuck.begin();
  for (std::size_t t = 1; t < signal.size(); ++t) {
    while (run != stuck.end() && t >= run->first + run->count) ++run;
    const bool still = run != stuck.end() && t >= run->first;
    if (!still && signal.value(t) == signal.value(t - 1)) out.push_back({t, 0});
  }
  return out;
}

// Samples at the end of the range on the side of `beyond`.
std::vector<WrongSample> cut_off(const Signal& signal, int beyond) {
  double end = signal.value(0);
  for (std::size_t t = 1; t < signal.size(); ++t)
    end = beyond > 0 ? std::max(end, signal.value(t)) : std::min(end, signal.value(t));
  std::vector<WrongSample> out;
  for (std::size_t t = 0; t < signal.size(); ++t) {
    if (signal.value(t) == end) out.push_back({t, beyond});
  }
  return out;
}

// Whether nothing lies between an end of the range and the noise: then that end is no value of the
// converter's.
bool stands_apart(const Signal& signal, double end) {
  constexpr double kFar = 5.0;  // standard deviations of a difference of neighbours
  double nearest = INFINITY;
  for (std::size_t t = 0; t < signal.size(); ++t) {
    const double off = std::abs(signal.value(t) - end);
    if (off > 0.0) nearest = std::min(nearest, off);
  }
  return nearest > kFar * difference_at(signal, 1, end);
}

void add_interpolation(const Signal& signal, std::vector<Defect>& out) {
  std::vector<double> x(std::min(signal.size(), kMostInterpolated));
  for (std::size_t t = 0; t < x.size(); ++t) x[t] = signal.value(t);
  const double beat = interpolation_beat(x);
  if (beat > 0.0) out.push_back({"interpolated_samples", signal.size(), beat, 0, 1, {}});
}

// `repeats`: those that lie neither in a stuck run nor at an end of the range.
void add_duplicates(const Signal& signal, const std::vector<StuckRun>& stuck,
                    const std::vector<double>& ends, std::vector<WrongSample> repeats,
                    std::vector<Defect>& out) {
  constexpr double kSurely = 6.0;     // standard deviations
  constexpr double kFewSound = 0.05;  // of those that repeat
  constexpr double kLags = kFurthest - kNearest + 1;
  if (repeats.size() < 2) return;
  const auto repeated = static_cast<double>(repeats.size());
  const double expected =
      static_cast<double>(signal.size()) * chance_of_repeat(signal, stuck, ends);
  const double deviation = std::sqrt(expected * (1.0 + 1.0 / kLags));
  const double excess = repeated - expected;
  // The chance is an approximation: what is within a fifth of it is not called a defect.
  if (!(excess > kSurely * deviation + 1.0 && excess > 0.2 * expected)) return;
  const std::size_t count = repeats.size();
  const std::size_t first = repeats.front().at;
  if (!(expected < kFewSound * repeated)) repeats.clear();
  out.push_back({"duplicated_samples", count, expected, first, 1, std::move(repeats)});
}

}  // namespace

std::vector<StuckRun> stuck_runs(const Signal& signal) {
  std::vector<StuckRun> out = long_runs(signal);
  if (out.empty()) return out;
  const Codes codes = codes_of(signal);
  // Where the noise is smaller than the step, to stand still is what it does.
  if (codes.distinct > 1 && stands_still(codes)) return {};
  drop_likely(signal, codes, out);
  return out;
}

std::vector<Defect> integrity(const Signal& signal) {
  std::vector<Defect> out;
  if (signal.size() < 2) return out;
  const Codes codes = codes_of(signal);
  if (codes.distinct < 2) return {{"stuck", signal.size(), 0.0, 0, 1, {}}};
  std::vector<StuckRun> stuck = long_runs(signal);
  drop_likely(signal, codes, stuck);
  if (!stuck.empty()) {
    std::size_t count = 0;
    for (const StuckRun& run : stuck) count += run.count;
    out.push_back({"stuck", count, 0.0, stuck.front().first, stuck.size(), {}});
  }
  // Noise thins out towards its extremes; a converter at its end piles samples up there.
  const auto piled = [](std::size_t at_end, std::size_t next_to_it) {
    return at_end >= kPile && at_end > 3 * next_to_it;
  };
  std::vector<WrongSample> repeats = repeats_of(signal, stuck);
  std::vector<double> ends;
  const auto saturated = [&](int beyond, std::size_t at_end, std::size_t next_to_it) {
    if (!piled(at_end, next_to_it)) return;
    std::vector<WrongSample> there = cut_off(signal, beyond);
    const double end = signal.value(there.front().at);
    const bool apart = stands_apart(signal, end);
    if (apart) {
      for (WrongSample& one : there) one.beyond = 0;
    }
    // There every sample repeats the one before: that is no defect of its own.
    ends.push_back(end);
    std::erase_if(repeats,
                  [&](const WrongSample& one) { return signal.value(one.at) == ends.back(); });
    out.push_back({apart ? "dropouts" : "saturation", at_end,
                   apart ? end : static_cast<double>(next_to_it), there.front().at, 1,
                   std::move(there)});
  };
  saturated(1, codes.highest, codes.below_highest);
  saturated(-1, codes.lowest, codes.above_lowest);
  add_duplicates(signal, stuck, ends, std::move(repeats), out);
  if (codes.missing > 0)
    out.push_back({"missing_codes", codes.missing, codes.missed, 0, codes.missing, {}});
  if (is_coarse(codes))
    out.push_back({"quantisation", codes.distinct, change_in_steps(codes), 0, 1, {}});
  add_interpolation(signal, out);
  return out;
}

}  // namespace imunoise
