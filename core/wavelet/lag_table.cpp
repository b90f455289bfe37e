#include "core/wavelet/lag_table.h"

#include <algorithm>
#include <cmath>

namespace imunoise {
namespace {

using Complex = std::complex<double>;

// So fast that next to no digits are lost where Γ's polynomials are not split off, and soon
// forgotten.
bool fits(const ExponentialCovariance& one) {
  constexpr double kSlowest = 0.05;  // per sample
  constexpr double kLongest = 1e-3;  // decay per sample
  return std::abs(one.log_root) > kSlowest && -one.log_root.real() > kLongest;
}

}  // namespace

LagTable::LagTable(const SumCovariance& process, std::size_t samples)
    : held_(process.exponentials.size()) {
  constexpr double kNothing = 45.0;  // e^-45: below the rounding of anything it is added to
  for (std::size_t i = 0; i < held_.size(); ++i) {
    const ExponentialCovariance& one = process.exponentials[i];
    held_[i] = fits(one);
    if (!held_[i]) continue;
    const auto reach = static_cast<std::size_t>(-kNothing / one.log_root.real()) + 1;
    sums_.resize(std::max(sums_.size(), std::min(reach, 2 * samples)), 0.0);
    const Complex kernel = -one.amplitude * one.root / (one.one_minus_root * one.one_minus_root);
    // Powers by products, begun anew often enough to lose no digits.
    constexpr std::size_t kAnew = 256;
    Complex power = 0.0;
    for (std::size_t h = 0; h < std::min(reach, sums_.size()); ++h) {
      power = h % kAnew == 0 ? std::exp(one.log_root * static_cast<double>(h)) : power * one.root;
      sums_[h] += (kernel * power).real();
    }
  }
}

}  // namespace imunoise
