#include "core/wavelet/robust_variance.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <span>
#include <vector>

#include "core/support/parallel.h"

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

// mean χ(W/√ν) - E χ. Zero at the estimate; negative for ν too large.
double balance(std::span<const double> squares, double variance, const Biweight& form) {
  const double inner = 1.0 / variance;
  const double outer = 1.0 / (variance * form.cut * form.cut);
  double sum = 0.0;
  for (const double w2 : squares) {
    const double rest = std::max(0.0, 1.0 - w2 * outer);
    const double rest2 = rest * rest;
    sum += w2 * inner * rest2 * rest2;
  }
  return sum / static_cast<double>(squares.size()) - form.expectation;
}

double solve(std::span<const double> squares, const Biweight& form) {
  double sum = 0.0;
  for (const double w2 : squares) sum += w2;
  double high = 4.0 * sum / static_cast<double>(squares.size());
  if (high == 0.0) return 0.0;
  // Go down until the balance turns positive. Data that are mostly zero never do: take what comes
  // nearest.
  constexpr double kStep = 0.8;
  double low = high;
  double nearest = high;
  double best = balance(squares, high, form);
  for (int step = 0; step < 150 && best < 0.0; ++step) {
    high = low;
    low *= kStep;
    const double value = balance(squares, low, form);
    if (value > best) {
      best = value;
      nearest = low;
    }
  }
  if (best < 0.0) return nearest;
  low = nearest;
  double at_low = best;
  double at_high = balance(squares, high, form);
  int side = 0;
  for (int step = 0; step < 200 && high - low > 1e-14 * high;
       ++step) {  // regula falsi, Illinois form
    const double middle =
        std::clamp((low * at_high - high * at_low) / (at_high - at_low), low, high);
    const double value = balance(squares, middle, form);
    if (value == 0.0) return middle;
    if (value > 0.0) {
      low = middle;
      at_low = value;
      if (side == 1) at_high *= 0.5;
      side = 1;
    } else {
      high = middle;
      at_high = value;
      if (side == -1) at_low *= 0.5;
      side = -1;
    }
  }
  return 0.5 * (low + high);
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
    for (std::size_t t = 0; t < squares.size(); ++t) {
      const double w = ((prefix[t + 2 * m] - prefix[t + m]) - (prefix[t + m] - prefix[t])) * unit;
      squares[t] = w * w;
    }
    out.variance(static_cast<Eigen::Index>(i)) = solve(squares, form);
    progress.report(static_cast<double>(++done) / static_cast<double>(scales.size()));
  });
  set_chi_square_interval(out);
  return out;
}

}  // namespace imunoise
