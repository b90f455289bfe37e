#include "core/integrity/integrity.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

namespace imunoise {
namespace {

// What a recording of values on a grid looks like, in steps of that grid.
struct Codes {
  double step = 0.0;              // smallest difference between two values that occur
  double spread = 0.0;            // standard deviation of the difference of neighbours
  std::size_t distinct = 0;       // values that occur, counted up to kMany
  std::size_t repeats = 0;        // samples equal to the one before
  std::size_t lowest = 0;         // samples at the smallest value
  std::size_t highest = 0;        // at the largest
  std::size_t below_highest = 0;  // at the value next to it
  std::size_t above_lowest = 0;
};

constexpr std::size_t kMany = 100'000;  // distinct values: no grid worth the name

constexpr std::size_t kPile = 5;  // samples at an end of the range that are no chance

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
  return out;
}

// Chance that a sample of normal noise falls on the code of the one before.
double same_code(const Codes& codes) {
  return std::min(0.9, codes.step / (codes.spread * std::sqrt(2.0 * std::numbers::pi)));
}

// Below half a step of noise, rounding is no longer white noise of step²/12.
bool is_coarse(const Codes& codes) { return codes.step > 0.0 && codes.spread < 0.7 * codes.step; }

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

// Leaves the runs that noise of this step and size never makes.
void drop_likely(std::vector<StuckRun>& runs, const Codes& codes, std::size_t samples) {
  if (codes.distinct < 2) return;
  const double same = same_code(codes);
  std::erase_if(runs, [&](const StuckRun& run) {
    return !never_so_long(run.count, static_cast<double>(samples), same);
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

}  // namespace

std::vector<StuckRun> stuck_runs(const Signal& signal) {
  std::vector<StuckRun> out = long_runs(signal);
  if (out.empty()) return out;
  const Codes codes = codes_of(signal);
  // Where the noise is smaller than the step, to stand still is what it does.
  if (codes.distinct > 1 && is_coarse(codes)) return {};
  drop_likely(out, codes, signal.size());
  return out;
}

std::vector<Defect> integrity(const Signal& signal) {
  std::vector<Defect> out;
  if (signal.size() < 2) return out;
  const Codes codes = codes_of(signal);
  if (codes.distinct < 2) return {{"stuck", signal.size(), 0.0, 0, 1, {}}};
  std::vector<StuckRun> stuck = long_runs(signal);
  drop_likely(stuck, codes, signal.size());
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
  const auto saturated = [&](int beyond, std::size_t at_end, std::size_t next_to_it) {
    if (!piled(at_end, next_to_it)) return;
    std::vector<WrongSample> there = cut_off(signal, beyond);
    // There every sample repeats the one before: that is no defect of its own.
    const double end = signal.value(there.front().at);
    std::erase_if(repeats, [&](const WrongSample& one) { return signal.value(one.at) == end; });
    out.push_back({"saturation", at_end, static_cast<double>(next_to_it), there.front().at, 1,
                   std::move(there)});
  };
  saturated(1, codes.highest, codes.below_highest);
  saturated(-1, codes.lowest, codes.above_lowest);
  constexpr double kSurely = 6.0;     // standard deviations
  constexpr double kFewSound = 0.05;  // of those that repeat
  const auto repeated = static_cast<double>(repeats.size());
  const double expected = static_cast<double>(signal.size()) * same_code(codes);
  const double excess = repeated - expected;
  // The chance is an approximation: what is within a fifth of it is not called a defect.
  if (excess > kSurely * std::sqrt(expected) + 1.0 && excess > 0.2 * expected) {
    const std::size_t count = repeats.size();
    const std::size_t first = repeats.front().at;
    if (!(expected < kFewSound * repeated)) repeats.clear();
    out.push_back({"duplicated_samples", count, expected, first, 1, std::move(repeats)});
  }
  if (is_coarse(codes)) out.push_back({"quantisation", codes.distinct, 0.0, 0, 1, {}});
  return out;
}

}  // namespace imunoise
