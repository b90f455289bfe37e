#include "core/dynamic/covariate_bins.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace imunoise {
namespace {

constexpr std::size_t kCells = 200;  // of the covariate's range, in the search for plateaus
constexpr double kSparse = 0.2;  // of the mean count of a cell: below, the covariate only passes
constexpr double kSlack = 4.0;   // standard deviations that noise may take a run beyond its bin
constexpr double kReach = 3.0;   // of the distance of the outer percentiles from the median

struct Range {
  double lower;
  double upper;
};

using Sorted = std::span<const double>;

Sorted between(Sorted sorted, double lower, double upper) {
  const auto first = std::lower_bound(sorted.begin(), sorted.end(), lower);
  const auto last = std::upper_bound(first, sorted.end(), upper);
  return {first, last};
}

// About the values of one plateau, so that its own scatter does not cut it, yet no wider: what
// leads to and from it is no noise.
Range tight(Sorted plateau, const Range& limits) {
  const auto at = [&](double share) {
    return plateau[static_cast<std::size_t>(share * static_cast<double>(plateau.size() - 1))];
  };
  const double median = at(0.5);
  const double scatter = kReach * std::max(at(0.99) - median, median - at(0.01));
  const double reach = scatter + 1e-9 * (limits.upper - limits.lower);
  return {std::max(limits.lower, median - reach), std::min(limits.upper, median + reach)};
}

std::vector<Range> quantiles(Sorted sorted, std::size_t count) {
  std::vector<double> edges;
  for (std::size_t i = 0; i < count; ++i) edges.push_back(sorted[i * sorted.size() / count]);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<Range> out;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const double below =
        i + 1 < edges.size() ? std::nextafter(edges[i + 1], edges[i]) : sorted.back();
    out.push_back({edges[i], below});
  }
  return out;
}

std::vector<Range> about(Sorted sorted, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  std::vector<Range> out;
  for (std::size_t i = 0; i < values.size(); ++i) {
    double gap = std::numeric_limits<double>::infinity();
    if (i > 0) gap = values[i] - values[i - 1];
    if (i + 1 < values.size()) gap = std::min(gap, values[i + 1] - values[i]);
    if (!std::isfinite(gap)) gap = 2.0 * (sorted.back() - sorted.front());
    const Sorted near = between(sorted, values[i] - 0.25 * gap, values[i] + 0.25 * gap);
    if (near.empty()) continue;
    out.push_back(tight(near, {values[i] - 0.5 * gap, values[i] + 0.5 * gap}));
  }
  return out;
}

// Places where the covariate stays, with hardly a sample between them.
std::vector<Range> plateaus(Sorted sorted) {
  const double low = sorted.front();
  const double width = (sorted.back() - low) / static_cast<double>(kCells);
  if (!(width > 0.0)) return {};
  std::vector<std::size_t> counts(kCells, 0);
  for (const double x : sorted) {
    ++counts[std::min(kCells - 1, static_cast<std::size_t>((x - low) / width))];
  }
  const double least = kSparse * static_cast<double>(sorted.size()) / static_cast<double>(kCells);
  std::vector<Range> dense;
  bool inside = false;
  for (std::size_t i = 0; i < kCells; ++i) {
    const bool stays = static_cast<double>(counts[i]) >= least;
    const double edge = low + width * static_cast<double>(i);
    if (stays && !inside) dense.push_back({edge, edge});
    if (stays) dense.back().upper = i + 1 < kCells ? edge + width : sorted.back();
    inside = stays;
  }
  // A covariate that drifts fills its range; a dwell is more than a few samples.
  const auto count = [&](const Range& r) { return between(sorted, r.lower, r.upper).size(); };
  std::erase_if(dense, [&](const Range& r) { return 100 * count(r) < sorted.size(); });
  double filled = 0.0;
  for (const Range& range : dense) filled += range.upper - range.lower;
  if (dense.size() < 2 || filled > 0.5 * (sorted.back() - low)) return {};
  std::vector<Range> out;
  for (std::size_t i = 0; i < dense.size(); ++i) {
    const double reach = sorted.back() - low;
    const Range limits{
        i > 0 ? 0.5 * (dense[i - 1].upper + dense[i].lower) : low - reach,
        i + 1 < dense.size() ? 0.5 * (dense[i].upper + dense[i + 1].lower) : sorted.back() + reach};
    out.push_back(tight(between(sorted, dense[i].lower, dense[i].upper), limits));
  }
  return out;
}

std::optional<std::size_t> range_of(const std::vector<Range>& ranges, double x) {
  const auto after = std::upper_bound(ranges.begin(), ranges.end(), x,
                                      [](double value, const Range& r) { return value < r.lower; });
  if (after == ranges.begin() || x > std::prev(after)->upper) return std::nullopt;
  return static_cast<std::size_t>(std::prev(after) - ranges.begin());
}

// Standard deviation of the covariate's own noise, from second differences, which a slow course
// does not move: normal ones have a median of 0.6745 √6 of it.
double noise_of(std::span<const std::vector<double>> recordings) {
  std::vector<double> steps;
  for (const std::vector<double>& one : recordings) {
    for (std::size_t i = 2; i < one.size(); ++i) {
      steps.push_back(std::abs(one[i] - 2.0 * one[i - 1] + one[i - 2]));
    }
  }
  if (steps.empty()) return 0.0;
  const auto middle = steps.begin() + std::ssize(steps) / 2;
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle / (0.6745 * std::sqrt(6.0));
}

}  // namespace

Bins bin_by_covariate(std::span<const std::vector<double>> recordings, const BinOptions& options) {
  std::vector<double> sorted;
  for (const std::vector<double>& one : recordings) {
    sorted.insert(sorted.end(), one.begin(), one.end());
  }
  Bins out;
  if (sorted.empty()) return out;
  std::sort(sorted.begin(), sorted.end());
  std::vector<Range> ranges;
  if (!options.values.empty()) {
    ranges = about(sorted, options.values);
  } else if (options.count == 0) {
    ranges = plateaus(sorted);
  }
  out.plateaus = !ranges.empty();
  if (ranges.empty() && options.values.empty()) {
    ranges = quantiles(sorted, options.count > 0 ? options.count : kCustomaryBins);
  }
  for (const Range& range : ranges) {
    Bin& bin = out.bins.emplace_back();
    bin.lower = range.lower;
    bin.upper = range.upper;
  }
  // Where bins meet, noise alone does not end a run.
  const double slack = out.plateaus ? 0.0 : kSlack * noise_of(recordings);
  out.left_out = sorted.size();
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    const std::vector<double>& covariate = recordings[r];
    for (std::size_t begin = 0; begin < covariate.size();) {
      const auto bin = range_of(ranges, covariate[begin]);
      std::size_t end = begin + 1;
      const auto stays = [&](double x) {
        if (!bin || slack == 0.0) return range_of(ranges, x) == bin;
        return x >= ranges[*bin].lower - slack && x <= ranges[*bin].upper + slack;
      };
      while (end < covariate.size() && stays(covariate[end])) ++end;
      const std::size_t from = begin + options.settle;
      if (bin && end >= from + kLeastRun) {
        Bin& to = out.bins[*bin];
        to.runs.push_back({r, from, end - from});
        for (std::size_t i = from; i < end; ++i) to.mean += covariate[i];
        to.samples += end - from;
        out.left_out -= end - from;
      }
      begin = end;
    }
  }
  std::erase_if(out.bins, [](const Bin& bin) { return bin.runs.empty(); });
  for (Bin& bin : out.bins) bin.mean /= static_cast<double>(bin.samples);
  std::sort(out.bins.begin(), out.bins.end(),
            [](const Bin& a, const Bin& b) { return a.mean < b.mean; });
  return out;
}

}  // namespace imunoise
