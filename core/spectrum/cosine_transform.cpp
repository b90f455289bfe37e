#include "core/spectrum/cosine_transform.h"

#include <cassert>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <vector>

namespace imunoise {

namespace {

bool quick(std::size_t n) {
  for (const std::size_t factor : {2U, 3U, 5U, 7U, 11U, 13U}) {
    while (n % factor == 0) n /= factor;
  }
  return n == 1;
}

}  // namespace

std::size_t quick_length(std::size_t n) {
  while (n > 0 && !quick(n)) --n;
  return n;
}

Eigen::VectorXd cosine_transform(const VectorRef& x) {
  const Eigen::Index n = x.size();
  assert(n >= 2 && quick_length(static_cast<std::size_t>(n)) == static_cast<std::size_t>(n));
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

Eigen::VectorXd inverse_cosine_transform(const VectorRef& c) {
  const Eigen::Index n = c.size() + 1;
  assert(quick_length(static_cast<std::size_t>(n)) == static_cast<std::size_t>(n));
  // Makhoul's steps backwards: V_k = e^{iπk/2n} (c_k - i c_{n-k}) is the transform of the folded
  // series.
  const double scale = std::sqrt(0.5 * static_cast<double>(n));
  std::vector<std::complex<double>> spectrum(static_cast<std::size_t>(n));
  for (Eigen::Index k = 1; k < n; ++k) {
    const double angle = std::numbers::pi * static_cast<double>(k) / (2.0 * static_cast<double>(n));
    spectrum[static_cast<std::size_t>(k)] =
        scale * std::polar(1.0, angle) * std::complex<double>(c(k - 1), -c(n - k - 1));
  }
  std::vector<std::complex<double>> folded;
  Eigen::FFT<double> transform;
  transform.inv(folded, spectrum);
  Eigen::VectorXd out(n);
  for (Eigen::Index t = 0; t < n; ++t) {
    const Eigen::Index place = t % 2 == 0 ? t / 2 : n - 1 - t / 2;
    out(t) = folded[static_cast<std::size_t>(place)].real();
  }
  return out;
}

}  // namespace imunoise
