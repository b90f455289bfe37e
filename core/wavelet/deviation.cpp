#include "core/wavelet/deviation.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>

namespace imunoise {
namespace {

// Windows of m samples that a difference spans.
std::size_t windows(DeviationKind kind) { return kind == DeviationKind::kAllan ? 2 : 3; }

// Weights of the prefix sums S_t, S_{t-m}, ...
std::vector<double> weights(DeviationKind kind) {
  if (kind == DeviationKind::kAllan) return {1.0, -2.0, 1.0};
  return {1.0, -3.0, 3.0, -1.0};
}

// Generalised covariance of prefix sums at a lag of u windows of m samples, up to polynomials that
// the differences cancel.
double sum_covariance_at(NoiseType law, double u, double m) {
  const double lag = std::abs(u);
  switch (law) {
    case NoiseType::kQuantisation:
      return lag * m < 0.5 ? 1.0 : 0.0;
    case NoiseType::kWhite:
      return -0.5 * lag;
    case NoiseType::kRandomWalk:
      break;
  }
  return (lag * lag * lag - lag / (m * m)) / 12.0;
}

double difference_covariance(DeviationKind kind, NoiseType law, double u, double m) {
  const std::vector<double> p = weights(kind);
  double out = 0.0;
  for (std::size_t a = 0; a < p.size(); ++a) {
    for (std::size_t b = 0; b < p.size(); ++b)
      out += p[a] * p[b] *
             sum_covariance_at(law, u - static_cast<double>(a) + static_cast<double>(b), m);
  }
  return out;
}

}  // namespace

std::size_t difference_count(DeviationKind kind, std::size_t samples, std::size_t m) {
  const std::size_t span = windows(kind) * m;
  return samples < span ? 0 : samples - span + 1;
}

std::vector<std::size_t> customary_factors(DeviationKind kind, std::size_t samples) {
  std::vector<std::size_t> out;
  for (std::size_t decade = 1;; decade *= 10) {
    for (const std::size_t step : {1U, 2U, 4U}) {
      if (difference_count(kind, samples, step * decade) == 0) return out;
      out.push_back(step * decade);
    }
  }
}

Eigen::ArrayXd deviation_variance(DeviationKind kind, const Signal& signal,
                                  const std::vector<std::size_t>& factors) {
  // The first sample is taken off: a constant bias would cost digits.
  std::vector<double> sums(signal.size() + 1, 0.0);
  const double first = signal.size() > 0 ? signal.value(0) : 0.0;
  for (std::size_t i = 0; i < signal.size(); ++i) sums[i + 1] = sums[i] + (signal.value(i) - first);
  const std::vector<double> p = weights(kind);
  const double scale = kind == DeviationKind::kAllan ? 2.0 : 6.0;
  Eigen::ArrayXd out(static_cast<Eigen::Index>(factors.size()));
  for (std::size_t j = 0; j < factors.size(); ++j) {
    const std::size_t m = factors[j];
    const std::size_t count = difference_count(kind, signal.size(), m);
    assert(count > 0);
    double total = 0.0;
    for (std::size_t t = 0; t < count; ++t) {
      double difference = 0.0;
      for (std::size_t a = 0; a < p.size(); ++a) difference += p[a] * sums[t + a * m];
      total += difference * difference;
    }
    const auto width = static_cast<double>(m);
    out(static_cast<Eigen::Index>(j)) =
        total / (static_cast<double>(count) * scale * width * width);
  }
  return out;
}

NoiseType nearest_law(double slope) {
  if (slope < -1.5) return NoiseType::kQuantisation;
  return slope < -0.5 ? NoiseType::kWhite : NoiseType::kRandomWalk;
}

double deviation_degrees(DeviationKind kind, NoiseType law, std::size_t samples, std::size_t m) {
  const auto count = static_cast<double>(difference_count(kind, samples, m));
  const auto width = static_cast<double>(m);
  // Rounding errors are correlated at lags of whole windows alone.
  const std::size_t stride =
      law == NoiseType::kQuantisation ? m : std::max<std::size_t>(m / 256, 1);
  const double zero = difference_covariance(kind, law, 0.0, width);
  double sum =
      count * zero * zero * (law == NoiseType::kQuantisation ? 1.0 : static_cast<double>(stride));
  for (std::size_t s = stride; s <= windows(kind) * m && static_cast<double>(s) < count;
       s += stride) {
    const double g = difference_covariance(kind, law, static_cast<double>(s) / width, width);
    const double each = law == NoiseType::kQuantisation ? 1.0 : static_cast<double>(stride);
    sum += 2.0 * each * (count - static_cast<double>(s)) * g * g;
  }
  return std::max(count * count * zero * zero / sum, 1.0);
}

std::size_t lowest_deviation(std::span<const double> curve) {
  constexpr double kClearly = 1.5;
  constexpr std::size_t kFalls = 3;
  std::size_t top = 0;
  while (top + 1 < curve.size() && curve[top + 1] >= curve[top]) ++top;
  std::size_t end = top;
  while (end + 1 < curve.size() && curve[end + 1] < curve[end]) ++end;
  const bool hump = end >= top + kFalls && kClearly * curve[end] < curve[top];
  const auto from = curve.begin() + static_cast<std::ptrdiff_t>(hump ? top : 0);
  return static_cast<std::size_t>(std::min_element(from, curve.end()) - curve.begin());
}

}  // namespace imunoise
