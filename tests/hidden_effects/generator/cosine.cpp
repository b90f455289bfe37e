#include "tests/hidden_effects/generator/cosine.h"

#include <complex>
#include <numbers>
#include <utility>

namespace imunoise::hidden {
namespace {

using Complex = std::complex<double>;

// In place, forward, decimation in time.
void fourier(std::vector<Complex>& values) {
  const std::size_t n = values.size();
  for (std::size_t i = 1, j = 0; i < n; ++i) {
    std::size_t bit = n >> 1U;
    for (; (j & bit) != 0; bit >>= 1U) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(values[i], values[j]);
  }
  std::vector<Complex> roots(n / 2);
  for (std::size_t k = 0; k < n / 2; ++k) {
    roots[k] =
        std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n));
  }
  for (std::size_t half = 1; half < n; half *= 2) {
    for (std::size_t begin = 0; begin < n; begin += 2 * half) {
      for (std::size_t k = 0; k < half; ++k) {
        const Complex odd = values[begin + half + k] * roots[k * (n / (2 * half))];
        values[begin + half + k] = values[begin + k] - odd;
        values[begin + k] += odd;
      }
    }
  }
}

}  // namespace

// Makhoul 1980: even samples in order, odd ones backwards, one complex transform, one rotation.
Series cosine_coefficients(const Series& values) {
  const std::size_t n = values.size();
  assert(n >= 2 && (n & (n - 1)) == 0);
  std::vector<Complex> folded(n);
  for (std::size_t t = 0; t < n / 2; ++t) {
    folded[t] = values[2 * t];
    folded[n - 1 - t] = values[2 * t + 1];
  }
  fourier(folded);
  Series out(n);
  const double length = static_cast<double>(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double angle = -std::numbers::pi * static_cast<double>(k) / (2.0 * length);
    out[k] = std::sqrt((k == 0 ? 1.0 : 2.0) / length) * (folded[k] * std::polar(1.0, angle)).real();
  }
  return out;
}

}  // namespace imunoise::hidden
