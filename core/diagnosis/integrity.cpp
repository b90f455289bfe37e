#include "core/diagnosis/integrity.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace imunoise {
namespace {

// What a recording of values on a grid looks like, in steps of that grid.
struct Codes {
  double step = 0.0;         // smallest difference between two values that occur
  double spread = 0.0;       // standard deviation of the difference of neighbours
  std::size_t distinct = 0;  // values that occur, counted up to kMany
  std::size_t repeats = 0;   // samples equal to the one before
  std::size_t longest = 0;   // run of equal samples
  std::size_t longest_at = 0;
  std::size_t lowest = 0;         // samples at the smallest value
  std::size_t highest = 0;        // at the largest
  std::size_t below_highest = 0;  // at the value next to it
  std::size_t above_lowest = 0;
};

constexpr std::size_t kMany = 100'000;  // distinct values: no grid worth the name

// Samples at the extremes, which values without a grid have as well.
void count_ends(const Signal& signal, Codes& to) {
  double smallest = signal.value(0);
  double largest = smallest;
  for (std::size_t t = 0; t < signal.size(); ++t) {
    const double value = signal.value(t);
    if (value < smallest) to.lowest = 0;
    if (value > largest) to.highest = 0;
    smallest = std::min(smallest, value);
    largest = std::max(largest, value);
    to.lowest += value == smallest ? 1 : 0;
    to.highest += value == largest ? 1 : 0;
  }
}

Codes codes_of(const Signal& signal) {
  Codes out;
  std::map<double, std::size_t> counts;
  double squares = 0.0;
  double before = signal.value(0);
  std::size_t run = 1;
  for (std::size_t t = 0; t < signal.size(); ++t) {
    const double value = signal.value(t);
    if (counts.size() < kMany) ++counts[value];
    if (t == 0) continue;
    const double difference = value - before;
    squares += difference * difference;
    run = difference == 0.0 ? run + 1 : 1;
    out.repeats += difference == 0.0 ? 1 : 0;
    if (run > out.longest) {
      out.longest = run;
      out.longest_at = t + 1 - run;
    }
    before = value;
  }
  count_ends(signal, out);
  out.spread = std::sqrt(squares / static_cast<double>(signal.size()));
  out.distinct = counts.size();
  if (counts.size() >= kMany || counts.size() < 2) return out;
  out.step = INFINITY;
  for (auto one = std::next(counts.begin()); one != counts.end(); ++one)
    out.step = std::min(out.step, one->first - std::prev(one)->first);
  out.above_lowest = std::next(counts.begin())->second;
  out.below_highest = std::next(counts.rbegin())->second;
  return out;
}

}  // namespace

std::vector<Defect> integrity(const Signal& signal) {
  std::vector<Defect> out;
  if (signal.size() < 2) return out;
  const Codes codes = codes_of(signal);
  const auto n = static_cast<double>(signal.size());
  if (codes.distinct < 2) return {{"stuck", signal.size(), 0.0, 0}};
  // Two neighbours of normal noise fall on the same code with about this chance.
  const double same =
      std::min(0.9, codes.step / (codes.spread * std::sqrt(2.0 * std::numbers::pi)));
  const double expected = n * same;
  const auto repeats = static_cast<double>(codes.repeats);
  constexpr double kSurely = 6.0;  // standard deviations
  const double excess = repeats - expected;
  // The chance is an approximation: what is within a fifth of it is not called a defect.
  if (excess > kSurely * std::sqrt(expected) + 1.0 && excess > 0.2 * expected)
    out.push_back({"duplicated_samples", codes.repeats, expected, 0});
  // A run of L equal samples is expected n·same^(L-1) times.
  const auto length = static_cast<double>(codes.longest);
  constexpr double kNever = 1e-6;
  constexpr double kFewest = 8.0;
  if (length >= kFewest && std::log(n) + (length - 1.0) * std::log(same) < std::log(kNever))
    out.push_back({"stuck", codes.longest, 0.0, codes.longest_at});
  // Noise thins out towards its extremes; a converter at its end piles samples up there.
  const auto piled = [](std::size_t at_end, std::size_t next_to_it) {
    return at_end >= 5 && at_end > 3 * next_to_it;
  };
  if (piled(codes.highest, codes.below_highest))
    out.push_back({"saturation", codes.highest, static_cast<double>(codes.below_highest), 0});
  if (piled(codes.lowest, codes.above_lowest))
    out.push_back({"saturation", codes.lowest, static_cast<double>(codes.above_lowest), 0});
  // Below half a step of noise, rounding is no longer white noise of step²/12.
  if (codes.step > 0.0 && codes.spread < 0.7 * codes.step)
    out.push_back({"quantisation", codes.distinct, 0.0, 0});
  return out;
}

}  // namespace imunoise
