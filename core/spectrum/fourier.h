#pragma once

#include <complex>
#include <span>
#include <vector>

namespace imunoise {

/// Discrete Fourier transform of n ≥ 2 real numbers, X_k = Σ_t x_t e^{-2πikt/n}, at k = 0 … n/2.
/// Quick for a quick_length(); what depends on the length alone is kept for the thread's next call.
std::vector<std::complex<double>> half_spectrum(std::span<const double> x);

/// Its inverse: n numbers of their n/2 + 1 coefficients.
std::vector<double> from_half_spectrum(std::span<const std::complex<double>> spectrum,
                                       std::size_t n);

/// e^{iπk/2n} at k = 0 … n/2. Valid until the thread asks for another length.
std::span<const std::complex<double>> quarter_turns(std::size_t n);

}  // namespace imunoise
