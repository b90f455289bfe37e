#include "tests/hidden_effects/generator/oracle.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "tests/hidden_effects/generator/cosine.h"

namespace imunoise::hidden {

double mean_strength(const std::vector<Series>& shapes, const Series& spectrum) {
  double sum = 0.0;
  for (const Series& shape : shapes) {
    const Series coefficients = cosine_coefficients(shape);
    for (std::size_t k = 1; k < coefficients.size(); ++k) {
      sum += coefficients[k] * coefficients[k] / spectrum[k - 1];
    }
  }
  return std::sqrt(sum);
}

double divergence(const Series& before, const Series& after) {
  double sum = 0.0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    const double more = after[k] / before[k] - 1.0;
    sum += 0.5 * (more - std::log1p(more));
  }
  return sum;
}

double likelihood_ratio(const Series& coefficients, const Series& before, const Series& after) {
  double sum = 0.0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    const double square = coefficients[k + 1] * coefficients[k + 1];
    sum += 0.5 * (std::log(before[k] / after[k]) + square / before[k] - square / after[k]);
  }
  return sum;
}

double shared_divergence(const Series& a, const Series& b, const Series& common) {
  double sum = 0.0;
  for (std::size_t k = 0; k < common.size(); ++k) {
    const double c = common[k];
    sum -= 0.5 * std::log1p(-c * c / ((a[k] + c) * (b[k] + c)));
  }
  return sum;
}

// The Itakura-Saito divergence falls at every step of this multiplicative update (Févotte, Bertin &
// Durrieu 2009, section 2, with the exponent ½ of the majorisation).
Series nearest_sum(const Series& after, const std::vector<Series>& parts) {
  const std::size_t n = after.size();
  std::vector<double> levels(parts.size(), 1.0);
  Series sum(n);
  double last = 0.0;
  for (int step = 0; step < 500; ++step) {
    std::fill(sum.begin(), sum.end(), 0.0);
    for (std::size_t j = 0; j < parts.size(); ++j) {
      for (std::size_t k = 0; k < n; ++k) sum[k] += levels[j] * parts[j][k];
    }
    const double now = divergence(sum, after);
    if (step > 0 && std::abs(now - last) < 1e-4 * (1e-3 + now)) break;
    last = now;
    for (std::size_t j = 0; j < parts.size(); ++j) {
      double up = 0.0;
      double down = 0.0;
      for (std::size_t k = 0; k < n; ++k) {
        up += parts[j][k] * after[k] / (sum[k] * sum[k]);
        down += parts[j][k] / sum[k];
      }
      levels[j] *= std::sqrt(up / down);
    }
  }
  return sum;
}

// The midpoint rule over u, x = sinh u: the steps grow with the tails.
double mixture_divergence(const Series& weights, const Series& variances) {
  constexpr double kStep = 0.01;
  constexpr double kDensityAtZero = 0.3989422804014327;
  double variance = 0.0;
  for (std::size_t j = 0; j < weights.size(); ++j) variance += weights[j] * variances[j];
  const double widest = *std::max_element(variances.begin(), variances.end());
  const double end = std::asinh(8.0 * std::sqrt(widest));
  double out = 0.0;
  for (double u = 0.5 * kStep; u < end; u += kStep) {
    const double x = std::sinh(u);
    double density = 0.0;  // over that of N(0, 1) at zero
    for (std::size_t j = 0; j < weights.size(); ++j) {
      density += weights[j] / std::sqrt(variances[j]) * std::exp(-0.5 * x * x / variances[j]);
    }
    if (!(density > 0.0)) break;
    const double ratio = std::log(density) + 0.5 * std::log(variance) + 0.5 * x * x / variance;
    out += 2.0 * kStep * std::cosh(u) * kDensityAtZero * density * ratio;
  }
  return std::max(out, 0.0);
}

double outlier_divergence(double share, double factor) {
  return mixture_divergence({1.0 - share, share}, {1.0, 1.0 + factor * factor});
}

namespace {

// The logarithm of Bessel's I₀ (Abramowitz & Stegun 9.7.1 where it is large).
double log_bessel(double x) {
  constexpr double kLarge = 50.0;
  if (x < kLarge) return std::log(std::cyl_bessel_i(0.0, x));
  return x - 0.5 * std::log(2.0 * std::numbers::pi * x) + std::log1p(1.0 / (8.0 * x));
}

}  // namespace

// Of a wave in noise of variance 1, the observer sees the modulus r, which has Rice's distribution,
// and the ratio is I₀(δr)·exp(-δ²/2).
double phase_price(double delta) {
  constexpr double kStep = 0.01;
  constexpr double kFar = 9.0;
  double mean = 0.0;
  for (double r = std::max(0.0, delta - kFar) + 0.5 * kStep; r < delta + kFar; r += kStep) {
    const double bessel = log_bessel(delta * r);
    mean += kStep * r * std::exp(bessel - 0.5 * (r * r + delta * delta)) * bessel;
  }
  return delta * delta - mean;
}

double swing_strength(const Series& after) {
  const double mean =
      std::accumulate(after.begin(), after.end(), 0.0) / static_cast<double>(after.size());
  return strength(divergence(Series(after.size(), mean), after), 1.0);
}

double strength(double divergence, double count) { return std::sqrt(2.0 * divergence * count); }

double solve_strength(double delta, double low, double high,
                      const std::function<double(double)>& strength) {
  for (int i = 0; i < 60 && high / low > 1.0 + 1e-9; ++i) {
    const double middle = std::sqrt(low * high);
    (strength(middle) < delta ? low : high) = middle;
  }
  return high;
}

}  // namespace imunoise::hidden
