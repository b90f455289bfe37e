#include "core/spectrum/cosine_transform.h"

#include <cassert>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <vector>

namespace imunoise {

std::size_t quick_length(std::size_t n) {
  std::size_t best = 0;
  for (std::size_t fives = 4; fives <= n; fives *= 5) {
    for (std::size_t threes = fives; threes <= n; threes *= 3) {
      std::size_t length = threes;
      while (length * 2 <= n) length *= 2;
      best = std::max(best, length);
    }
  }
  return best;
}

Eigen::VectorXd cosine_transform(const VectorRef& x) {
  const Eigen::Index n = x.size();
  assert(quick_length(static_cast<std::size_t>(n)) == static_cast<std::size_t>(n));
  const double mean = x.mean();
  // Even samples forwards, then odd samples backwards: half the length of a mirrored series.
  std::vector<std::complex<double>> folded(static_cast<std::size_t>(n));
  for (Eigen::Index t = 0; t < n; ++t) {
    const Eigen::Index place = t % 2 == 0 ? t / 2 : n - 1 - t / 2;
    folded[static_cast<std::size_t>(place)] = x(t) - mean;
  }
  std::vector<std::complex<double>> spectrum;
  Eigen::FFT<double> transform;
  transform.fwd(spectrum, folded);
  const double scale = std::sqrt(2.0 / static_cast<double>(n));
  Eigen::VectorXd out(n - 1);
  for (Eigen::Index k = 1; k < n; ++k) {
    const double angle =
        -std::numbers::pi * static_cast<double>(k) / (2.0 * static_cast<double>(n));
    const std::complex<double>& one = spectrum[static_cast<std::size_t>(k)];
    out(k - 1) = scale * (one.real() * std::cos(angle) - one.imag() * std::sin(angle));
  }
  return out;
}

}  // namespace imunoise
