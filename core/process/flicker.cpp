#include "core/process/flicker.h"

#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "core/wavelet/sum_covariance_terms.h"

namespace imunoise {

Eigen::ArrayXd Flicker::shape(HalfWidths m) const {
  return m.unaryExpr([](double width) {
    const double total = 6.0 * flicker_sum_covariance(0.0) - 8.0 * flicker_sum_covariance(width) +
                         2.0 * flicker_sum_covariance(2.0 * width);
    return total / (4.0 * width * width);
  });
}

double Flicker::spectrum(const Frequency& f) const { return b2 / (2.0 * f.half_sine); }

std::vector<DerivedQuantity> Flicker::derived(Hertz) const {
  return {{Coefficient::kBiasInstability, std::sqrt(b2)}};
}

// The increments are stationary with autocovariance (4B²/π)/(1 - 4h²): simulated exactly by
// embedding it in a circulant (Davies & Harte 1987), then summed.
void Flicker::add_samples(RandomStream& rng, std::span<double> out) const {
  const std::size_t size = 2 * std::bit_ceil(out.size() + 1);
  std::vector<std::complex<double>> row(size);
  for (std::size_t i = 0; i < size; ++i) {
    const auto h = static_cast<double>(std::min(i, size - i));
    row[i] = 4.0 * b2 / std::numbers::pi / (1.0 - 4.0 * h * h);
  }
  Eigen::FFT<double> fft;
  std::vector<std::complex<double>> eigenvalues;
  fft.fwd(eigenvalues, row);
  for (std::size_t i = 0; i < size; ++i) {
    const double amplitude =
        std::sqrt(std::max(0.0, eigenvalues[i].real()) / static_cast<double>(size));
    const double real = rng.normal();
    row[i] = amplitude * std::complex<double>(real, rng.normal());
  }
  std::vector<std::complex<double>> noise;
  fft.fwd(noise, row);
  double level = 0.0;
  for (std::size_t t = 0; t < out.size(); ++t) out[t] += level += noise[t].real();
}

}  // namespace imunoise
