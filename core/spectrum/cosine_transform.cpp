#include "core/spectrum/cosine_transform.h"

#include <cassert>
#include <cmath>
#include <complex>
#include <utility>
#include <vector>

#include "core/spectrum/fourier.h"
#include "core/spectrum/roots_of_unity.h"

namespace imunoise {
namespace {

bool quick(std::size_t n) {
  for (const std::size_t factor : {2U, 3U, 5U, 7U, 11U, 13U}) {
    while (n % factor == 0) n /= factor;
  }
  return n == 1;
}

// Where sample t stands: even ones forwards, then odd ones backwards, which halves the length of a
// mirrored series (Makhoul 1980).
std::size_t folded_place(std::size_t t, std::size_t n) {
  return t % 2 == 0 ? t / 2 : n - 1 - t / 2;
}

// A series less its mean.
std::vector<double> folded(const VectorRef& x) {
  const auto n = static_cast<std::size_t>(x.size());
  assert(n >= 2 && quick_length(n) == n);
  const double mean = x.mean();
  std::vector<double> out(n);
  for (std::size_t t = 0; t < n; ++t)
    out[folded_place(t, n)] = x(static_cast<Eigen::Index>(t)) - mean;
  return out;
}

Eigen::VectorXd of_folded(std::vector<double> series) {
  const std::size_t n = series.size();
  const std::vector<std::complex<double>> spectrum = half_spectrum(std::move(series));
  const RootsOfUnity roots(4 * n);
  const double scale = std::sqrt(2.0 / static_cast<double>(n));
  Eigen::VectorXd out(static_cast<Eigen::Index>(n) - 1);
  // c_k = Re(e^{-iπk/2n} V_k), and V_{n-k} is the conjugate of V_k.
  for (std::size_t k = 1; k < spectrum.size(); ++k) {
    const std::complex<double> root = roots(k);
    const double real = scale * spectrum[k].real();
    const double imag = scale * spectrum[k].imag();
    out(static_cast<Eigen::Index>(n - k) - 1) = real * root.imag() - imag * root.real();
    out(static_cast<Eigen::Index>(k) - 1) = real * root.real() + imag * root.imag();
  }
  return out;
}

template <class Number>
Eigen::VectorXd inverse(const VectorRef& c) {
  const auto n = static_cast<std::size_t>(c.size()) + 1;
  assert(n >= 2 && quick_length(n) == n);
  const RootsOfUnity roots(4 * n);
  const double scale = std::sqrt(0.5 * static_cast<double>(n));
  std::vector<std::complex<Number>> spectrum(n / 2 + 1);
  for (std::size_t k = 1; k < spectrum.size(); ++k) {
    const std::complex<double> root = roots(k);
    const double near = scale * c(static_cast<Eigen::Index>(k) - 1);
    const double far = scale * c(static_cast<Eigen::Index>(n - k) - 1);
    spectrum[k] = {static_cast<Number>(near * root.real() + far * root.imag()),
                   static_cast<Number>(near * root.imag() - far * root.real())};
  }
  const std::vector<Number> folded = from_half_spectrum(std::move(spectrum), n);
  Eigen::VectorXd out(c.size() + 1);
  for (std::size_t t = 0; t < n; ++t)
    out(static_cast<Eigen::Index>(t)) = static_cast<double>(folded[folded_place(t, n)]);
  return out;
}

}  // namespace

std::size_t quick_length(std::size_t n) {
  while (n > 0 && !quick(n)) --n;
  return n;
}

std::size_t next_quick_length(std::size_t n) {
  while (!quick(n)) ++n;
  return n;
}

Eigen::VectorXd cosine_transform(Eigen::VectorXd x) {
  std::vector<double> series = folded(x);
  x.resize(0);  // its memory goes back, where it was given away
  return of_folded(std::move(series));
}

Eigen::VectorXd inverse_cosine_transform(const VectorRef& c) { return inverse<double>(c); }

Eigen::VectorXd rough_inverse_cosine_transform(const VectorRef& c) { return inverse<float>(c); }

}  // namespace imunoise
