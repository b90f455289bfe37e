#include "core/spectrum/fourier.h"

#include <numbers>
#include <unsupported/Eigen/FFT>

namespace imunoise {
namespace {

// Twiddle factors cost as much as a transform, and a recording's replicates have one length: each
// thread keeps those of the lengths that it used last.
class Plans {
 public:
  Eigen::FFT<double>& of(std::size_t n) {
    constexpr std::size_t kMostKept = 4;
    if (std::find(lengths_.begin(), lengths_.end(), n) == lengths_.end()) {
      if (lengths_.size() == kMostKept) *this = Plans();
      lengths_.push_back(n);
    }
    transform_.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    return transform_;
  }

 private:
  std::vector<std::size_t> lengths_;
  Eigen::FFT<double> transform_;
};

thread_local Plans plans;                              // NOLINT: a cache, of no consequence
thread_local std::vector<std::complex<double>> turns;  // NOLINT
thread_local std::size_t turned = 0;                   // NOLINT

}  // namespace

std::vector<std::complex<double>> half_spectrum(std::span<const double> x) {
  std::vector<std::complex<double>> out(x.size() / 2 + 1);
  plans.of(x.size()).fwd(out.data(), x.data(), static_cast<Eigen::Index>(x.size()));
  return out;
}

std::vector<double> from_half_spectrum(std::span<const std::complex<double>> spectrum,
                                       std::size_t n) {
  std::vector<double> out(n);
  plans.of(n).inv(out.data(), spectrum.data(), static_cast<Eigen::Index>(n));
  return out;
}

std::span<const std::complex<double>> quarter_turns(std::size_t n) {
  if (turned == n) return turns;
  turns.resize(n / 2 + 1);
  for (std::size_t k = 0; k < turns.size(); ++k)
    turns[k] =
        std::polar(1.0, std::numbers::pi * static_cast<double>(k) / (2.0 * static_cast<double>(n)));
  turned = n;
  return turns;
}

}  // namespace imunoise
