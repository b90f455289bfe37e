#pragma once

#include <complex>
#include <cstddef>
#include <vector>

namespace imunoise {

/// Points of the unit circle, e^{2πik/n} at k = 0 … n, to 1e-15: products of two short tables, for
/// a sine for each would take as long as a Fourier transform, and a table of all more memory than
/// its series.
class RootsOfUnity {
 public:
  explicit RootsOfUnity(std::size_t n);
  std::complex<double> operator()(std::size_t k) const {
    const std::complex<double> a = coarse_[k >> bits_];
    const std::complex<double> b = fine_[k & (fine_.size() - 1)];
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
  }

 private:
  unsigned bits_;  // of k that the fine table has: about half, so that both tables are short
  std::vector<std::complex<double>> coarse_;
  std::vector<std::complex<double>> fine_;
};

}  // namespace imunoise
