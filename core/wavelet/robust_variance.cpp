#include "core/wavelet/robust_variance.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/support/parallel.h"
#include "core/support/roots.h"
#include "core/wavelet/kernels.h"

namespace imunoise {
namespace {

struct Biweight {
  double nominal;      // efficiency the peers call it by
  double cut;          // c, in standard deviations
  double expectation;  // E χ(r), r ~ N(0,1)
};

constexpr Biweight biweight(RobustEfficiency efficiency) {
  switch (efficiency) {
    case RobustEfficiency::k60:
      return {0.6, 4.973362134160212, 0.6367236798738104};
    case RobustEfficiency::k80:
      return {0.8, 5.649311657030598, 0.7003494190259058};
    case RobustEfficiency::k90:
      break;
  }
  return {0.9, 6.622235003202644, 0.7684379848790425};
}

// mean χ(W/√ν) - E χ at one ν, and its derivative by ln ν. Zero at the estimate; negative for ν too
// large.
struct Balance {
  double value;
  double slope;
};

// At several ν in one pass over the squared coefficients, a block in the processor's cache at a
// time.
template <std::size_t N>
std::array<Balance, N> balance(std::span<const double> squares,
                               const std::array<double, N>& variances, const Biweight& form) {
  const Kernels& use = kernels();
  std::array<Balance, N> out{};
  for (std::size_t from = 0; from < squares.size(); from += kBlock) {
    const std::size_t count = std::min(kBlock, squares.size() - from);
    for (std::size_t k = 0; k < N; ++k) {
      double slope = 0.0;
      out[k].value += use.biweight_sum(squares.data() + from,
                                       1.0 / (variances[k] * form.cut * form.cut), count, &slope);
      out[k].slope -= slope;
    }
  }
  for (std::size_t k = 0; k < N; ++k) {
    const double each = 1.0 / (variances[k] * static_cast<double>(squares.size()));
    out[k].value = out[k].value * each - form.expectation;
    out[k].slope *= each;
  }
  return out;
}

// The root between `low`, where the balance is not negative, and low / step, where it is.
double root_in_step(std::span<const double> squares, double low, double step, double at_low,
                    double at_high, const Biweight& form) {
  const double width = -std::log(step);
  const auto at = [&](double log_ratio) {
    const Balance here = balance(squares, std::array{low * std::exp(log_ratio)}, form)[0];
    return std::pair(here.value, here.slope);
  };
  const double secant = width * at_low / (at_low - at_high);
  return low * std::exp(root_by_newton(at, secant, 0.0, width));
}

// The largest root, given the mean of the squares: no root is beyond mean / E χ, since χ(r) ≤ r².
// Goes down from there in steps until the balance turns positive. Data that are mostly zero never
// do: what comes nearest is taken.
double scanned_root(std::span<const double> squares, double mean, const Biweight& form) {
  if (!(mean > 0.0)) return 0.0;
  constexpr double kStep = 0.8;
  constexpr std::size_t kTogether = 4;
  constexpr int kPasses = 36;
  double next = mean / form.expectation;
  double nearest = next;
  double best = -form.expectation;
  double above = best;  // the balance one step above
  for (int pass = 0; pass < kPasses; ++pass) {
    std::array<double, kTogether> tried{};
    for (double& at : tried) at = std::exchange(next, next * kStep);
    const auto found = balance(squares, tried, form);
    for (std::size_t k = 0; k < kTogether; ++k) {
      if (found[k].value >= 0.0)
        return root_in_step(squares, tried[k], kStep, found[k].value, above, form);
      if (found[k].value > best) nearest = tried[k];
      best = std::max(best, found[k].value);
      above = found[k].value;
    }
  }
  return nearest;
}

constexpr std::size_t kMany = std::size_t{1} << 16;
constexpr std::size_t kThin = 16;

// The root for one block in sixteen: near that for all of them.
double root_of_few(std::span<const double> squares, const Biweight& form) {
  std::vector<double> few;
  double sum = 0.0;
  for (std::size_t from = 0; from + kBlock <= squares.size(); from += kThin * kBlock) {
    const auto block = squares.subspan(from, kBlock);
    few.insert(few.end(), block.begin(), block.end());
    sum = std::accumulate(block.begin(), block.end(), sum);
  }
  return scanned_root(few, sum / static_cast<double>(few.size()), form);
}

// Newton's method on the logarithm from a root that is near; none where it does not arrive at once,
// and there the whole range is scanned.
std::optional<double> root_near(std::span<const double> squares, double near,
                                const Biweight& form) {
  constexpr int kRounds = 5;
  constexpr double kFarthest = 0.1;
  constexpr double kClose = 1e-8;  // the last step but one: it leaves the square of this
  double at = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    const Balance here = balance(squares, std::array{near * std::exp(at)}, form)[0];
    const double step = -here.value / here.slope;
    at += step;
    if (!(std::abs(at) < kFarthest)) return std::nullopt;
    if (std::abs(step) < kClose) return near * std::exp(at);
  }
  return std::nullopt;
}

double solve(std::span<const double> squares, double mean, const Biweight& form) {
  if (squares.size() >= kMany) {
    const double near = root_of_few(squares, form);
    if (near > 0.0) {
      if (const auto found = root_near(squares, near, form)) return *found;
    }
  }
  return scanned_root(squares, mean, form);
}

}  // namespace

double nominal_efficiency(RobustEfficiency efficiency) { return biweight(efficiency).nominal; }

WaveletVariance robust_wavelet_variance(const Signal& signal, const Scales& scales,
                                        RobustEfficiency efficiency, double confidence,
                                        const Progress& progress) {
  assert(scales.empty() || static_cast<std::size_t>(2 * scales.largest()) <= signal.size());
  const Biweight form = biweight(efficiency);
  std::vector<double> prefix(signal.size() + 1, 0.0);
  std::visit(
      [&](auto samples) {
        double mean = 0.0;
        for (const auto x : samples) mean += static_cast<double>(x);
        mean = std::round(mean / static_cast<double>(std::max<std::size_t>(1, samples.size())));
        for (std::size_t t = 0; t < samples.size(); ++t) {
          prefix[t + 1] = prefix[t] + (static_cast<double>(samples[t]) - mean);
        }
      },
      signal.samples());

  WaveletVariance out;
  out.scales = scales;
  out.confidence = confidence;
  out.efficiency = form.nominal;
  out.samples = signal.size();
  out.rate = signal.rate();
  out.quantity = signal.quantity();
  out.variance.resize(static_cast<Eigen::Index>(scales.size()));
  std::atomic<int> done = 0;
  for_each_index(scales.size(), [&](std::size_t i) {
    if (progress.stopped()) return;
    const auto m = static_cast<std::size_t>(scales[i]);
    std::vector<double> squares(signal.size() - 2 * m + 1);
    const double unit = signal.scale() / (2.0 * static_cast<double>(m));
    const double sum =
        kernels().squared_coefficients(prefix.data(), prefix.data() + m, prefix.data() + 2 * m,
                                       unit, squares.size(), squares.data());
    out.variance(static_cast<Eigen::Index>(i)) =
        solve(squares, sum / static_cast<double>(squares.size()), form);
    progress.report(static_cast<double>(++done) / static_cast<double>(scales.size()));
  });
  set_chi_square_interval(out);
  return out;
}

}  // namespace imunoise
