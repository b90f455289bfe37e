#include "tests/hidden_effects/generator/oracle.h"

#include <algorithm>
#include <cmath>

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

double outlier_divergence(double share, double factor) {
  const double wide = std::sqrt(1.0 + factor * factor);
  constexpr double kStep = 0.01;
  constexpr double kDensityAtZero = 0.3989422804014327;
  double out = 0.0;
  for (double x = 0.5 * kStep; x < 8.0 * wide; x += kStep) {
    const double bell = kDensityAtZero * std::exp(-0.5 * x * x);
    const double broad = kDensityAtZero / wide * std::exp(-0.5 * x * x / (wide * wide));
    const double exponent = 0.5 * x * x * (1.0 - 1.0 / (wide * wide));
    const double ratio = exponent < 500.0 ? std::log1p(share * (std::exp(exponent) / wide - 1.0))
                                          : std::log(share / wide) + exponent;
    out += 2.0 * kStep * ((1.0 - share) * bell + share * broad) * ratio;
  }
  // So far from N(0, 1); the divergence of the normal law nearest to the mixture adds to the rest.
  const double more = share * factor * factor;
  return std::max(out - 0.5 * (more - std::log1p(more)), 0.0);
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
