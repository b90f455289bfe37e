#include "core/process/finite_memory.h"

#include <utility>

namespace imunoise {
namespace {

// The wavelet variance of an autocovariance that ends after a few lags.
Eigen::ArrayXd variance_of(const std::vector<double>& gamma, HalfWidths m) {
  return m.unaryExpr([&](double width) {
    double sum = 2.0 * width * gamma[0];
    for (std::size_t lag = 1; lag < gamma.size(); ++lag) {
      const auto h = static_cast<double>(lag);
      if (h >= 2.0 * width) break;
      sum += 2.0 * gamma[lag] * (h < width ? 2.0 * width - 3.0 * h : h - 2.0 * width);
    }
    return sum / (4.0 * width * width);
  });
}

}  // namespace

FiniteMemory::FiniteMemory(std::vector<double> taps)
    : taps_(std::move(taps)), gamma_(taps_.size()) {
  for (std::size_t h = 0; h < taps_.size(); ++h) {
    for (std::size_t i = 0; i + h < taps_.size(); ++i) gamma_[h] += taps_[i] * taps_[i + h];
  }
}

Eigen::ArrayXd FiniteMemory::variance(HalfWidths m) const { return variance_of(gamma_, m); }

Eigen::ArrayXd FiniteMemory::slope(HalfWidths m, std::size_t k) const {
  std::vector<double> gamma_slope(taps_.size());
  for (std::size_t h = 0; h < taps_.size(); ++h) {
    if (k + h < taps_.size()) gamma_slope[h] += taps_[k + h];
    if (k >= h) gamma_slope[h] += taps_[k - h];
  }
  return variance_of(gamma_slope, m);
}

SumCovariance FiniteMemory::sum_covariance() const {
  double total = gamma_[0];
  for (std::size_t h = 1; h < gamma_.size(); ++h) total += 2.0 * gamma_[h];
  // Γ(s) = -½ Σ_h γ(h)|s - h|; what is left of it beyond the linear part: -Σ_{h>s} γ(h)(h - s).
  SumCovariance out{.linear = -0.5 * total, .near = std::vector<double>(gamma_.size() - 1)};
  double beyond = 0.0;  // Σ_{h>s} γ(h)
  double rest = 0.0;
  for (std::size_t s = gamma_.size() - 1; s-- > 0;) {
    beyond += gamma_[s + 1];
    rest -= beyond;
    out.near[s] = rest;
  }
  return out;
}

FiniteMemory::Recursion::Recursion(std::vector<double> taps, double sigma, RandomStream& rng)
    : taps_(std::move(taps)), sigma_(sigma), inputs_(2 * taps_.size()) {
  for (std::size_t i = 1; i < taps_.size(); ++i) take(sigma_ * rng.normal());
}

void FiniteMemory::Recursion::take(double input) {
  inputs_[end_] = inputs_[end_ + taps_.size()] = input;
  end_ = (end_ + 1) % taps_.size();
}

double FiniteMemory::Recursion::next(RandomStream& rng) {
  take(sigma_ * rng.normal());
  const std::size_t newest = end_ + taps_.size() - 1;
  double out = 0.0;
  for (std::size_t i = 0; i < taps_.size(); ++i) out += taps_[i] * inputs_[newest - i];
  return out;
}

}  // namespace imunoise
