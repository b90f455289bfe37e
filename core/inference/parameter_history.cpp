#include "core/inference/parameter_history.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/support/distributions.h"
#include "core/support/roots.h"

namespace imunoise {
namespace {

constexpr int kNodes = 64;      // of the average over τ²
constexpr double kCrowd = 6.0;  // nodes crowd where τ² is large, which decides small p-values

// Weighted least squares at one τ².
struct Line {
  double misfit = 0.0;    // Q(τ²)
  double value = 0.0;     // the mean, or the slope
  double variance = 0.0;  // of `value`
};

struct Sums {
  double weight = 0.0;
  double time = 0.0;   // weighted mean
  double value = 0.0;  // weighted mean
  double xx = 0.0;
  double tx = 0.0;
  double tt = 0.0;
};

Sums sums_of(std::span<const DatedEstimate> estimates, double tau2) {
  Sums out;
  for (const DatedEstimate& one : estimates) {
    const double w = 1.0 / (one.variance + tau2);
    out.weight += w;
    out.time += w * one.time;
    out.value += w * one.value;
  }
  out.time /= out.weight;
  out.value /= out.weight;
  for (const DatedEstimate& one : estimates) {
    const double w = 1.0 / (one.variance + tau2);
    const double x = one.value - out.value;
    const double t = one.time - out.time;
    out.xx += w * x * x;
    out.tx += w * t * x;
    out.tt += w * t * t;
  }
  return out;
}

struct Mean {
  static constexpr std::size_t kParameters = 1;
  Line operator()(std::span<const DatedEstimate> estimates, double tau2) const {
    const Sums sums = sums_of(estimates, tau2);
    return {sums.xx, sums.value, 1.0 / sums.weight};
  }
};

struct Slope {
  static constexpr std::size_t kParameters = 2;
  Line operator()(std::span<const DatedEstimate> estimates, double tau2) const {
    const Sums sums = sums_of(estimates, tau2);
    const double slope = sums.tx / sums.tt;
    return {std::max(0.0, sums.xx - slope * sums.tx), slope, 1.0 / sums.tt};
  }
};

// A possible τ², and the line there.
struct Node {
  double weight = 0.0;
  double tau2 = 0.0;
  Line line;
};

// Q(τ²) falls; the largest possible τ² is where residuals of the unweighted line over it are u.
template <class Fit>
double tau2_at(std::span<const DatedEstimate> estimates, double u, const Fit& fit) {
  if (fit(estimates, 0.0).misfit <= u) return 0.0;
  std::vector<DatedEstimate> unweighted(estimates.begin(), estimates.end());
  for (DatedEstimate& one : unweighted) one.variance = 1.0;
  const double high = 2.0 * fit(unweighted, 0.0).misfit / u;  // beyond it, whatever is rounded
  return root_between([&](double tau2) { return fit(estimates, tau2).misfit - u; }, 0.0, high);
}

// The fiducial distribution of τ²: where Q(τ²) is each quantile of χ².
template <class Fit>
std::vector<Node> nodes_of(std::span<const DatedEstimate> estimates, const Fit& fit) {
  const auto dof = static_cast<double>(estimates.size() - Fit::kParameters);
  std::vector<Node> out;
  for (int i = 0; i < kNodes; ++i) {
    const double v = (i + 0.5) / kNodes;
    const double probability = std::pow(v, kCrowd);
    const double tau2 = tau2_at(estimates, chi_square_quantile(probability, dof), fit);
    out.push_back({kCrowd * std::pow(v, kCrowd - 1.0) / kNodes, tau2, fit(estimates, tau2)});
  }
  double all = 0.0;
  for (const Node& one : out) all += one.weight;
  for (Node& one : out) one.weight /= all;
  return out;
}

// The chance that a normal number is this many standard deviations from its mean, or more.
double two_sided(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }

// The chance of an estimate as far from the mean of the history as `value`.
double p_value(const std::vector<Node>& history, double value, double variance) {
  double out = 0.0;
  for (const Node& node : history) {
    const double spread = std::sqrt(variance + node.tau2 + node.line.variance);
    out += node.weight * two_sided((value - node.line.value) / spread);
  }
  return out;
}

double mean_of(const std::vector<Node>& history) {
  double out = 0.0;
  for (const Node& node : history) out += node.weight * node.line.value;
  return out;
}

}  // namespace

std::optional<ChangeTest> test_newest(std::span<const DatedEstimate> estimates) {
  if (estimates.size() < kLeastHistory + 1) return std::nullopt;
  const std::vector<Node> history = nodes_of(estimates.first(estimates.size() - 1), Mean{});
  const DatedEstimate& newest = estimates.back();
  return ChangeTest{newest.value - mean_of(history),
                    p_value(history, newest.value, newest.variance)};
}

std::optional<ChangeTest> test_trend(std::span<const DatedEstimate> estimates) {
  if (estimates.size() < kLeastHistory + 1) return std::nullopt;
  const auto [first, last] = std::minmax_element(
      estimates.begin(), estimates.end(),
      [](const DatedEstimate& a, const DatedEstimate& b) { return a.time < b.time; });
  const double span = last->time - first->time;
  if (!(span > 0.0)) return std::nullopt;
  ChangeTest out{0.0, 0.0};
  for (const Node& node : nodes_of(estimates, Slope{})) {
    out.change += node.weight * node.line.value * span;
    out.p_value += node.weight * two_sided(node.line.value / std::sqrt(node.line.variance));
  }
  return out;
}

std::optional<ExpectedRange> expected_next(std::span<const DatedEstimate> history, double variance,
                                           double level) {
  if (history.size() < kLeastHistory) return std::nullopt;
  const std::vector<Node> nodes = nodes_of(history, Mean{});
  const double centre = mean_of(nodes);
  const auto end = [&](double direction) {
    const auto above = [&](double distance) {
      return p_value(nodes, centre + direction * distance, variance) - level;
    };
    if (above(0.0) <= 0.0) return centre;
    double outside = std::sqrt(variance);
    while (above(outside) > 0.0) outside *= 2.0;
    return centre + direction * root_between(above, 0.0, outside);
  };
  return ExpectedRange{centre, end(-1.0), end(1.0)};
}

}  // namespace imunoise
