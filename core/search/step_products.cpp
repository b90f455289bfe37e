#include "core/search/step_products.h"

#include <cmath>
#include <complex>
#include <numbers>
#include <optional>

#include "core/spectrum/fourier.h"
#include "core/spectrum/roots_of_unity.h"
#include "core/support/parallel.h"

namespace imunoise {

using Index = Eigen::Index;

// The cosine transform of the step before t0 is √(2/n) sin(πk t0/n) / (2 sin(πk/2n)), so that the
// information of two steps is a difference of Σ_k w_k cos(πk d/n)/n at d = |s - t| and s + t, with
// w_k = 1/(4 sin²(πk/2n) S_k).
StepProducts::StepProducts(const Eigen::VectorXd& weighted, const Eigen::ArrayXd& spectrum)
    : product_(Eigen::VectorXd::Zero(weighted.size() + 1)) {
  const Index n = weighted.size();
  std::vector<double> weight(static_cast<std::size_t>(2 * n), 0.0);
  double total = 0.0;
  double turning = 0.0;
  const RootsOfUnity roots(4 * static_cast<std::size_t>(n));
  for (Index k = 1; k < n; ++k) {
    const double turn = std::numbers::pi * static_cast<double>(k) / static_cast<double>(n);
    const double s = 2.0 * roots(static_cast<std::size_t>(k)).imag();
    const double w = 1.0 / (s * s * spectrum(k - 1) * static_cast<double>(n));
    weight[static_cast<std::size_t>(k)] = w;
    total += w;
    turning += w * turn * turn;
  }
  path_ = static_cast<double>(n) * std::sqrt(turning / total);
  for (const std::complex<double>& one : half_spectrum(std::move(weight)))
    wave_.push_back(one.real());
  for (Index t = n - 1; t >= 1; --t) product_(t) = product_(t + 1) + weighted(t);
}

std::vector<StepProducts> step_products(const Current& current) {
  std::vector<std::optional<StepProducts>> each(current.weighted.size());
  for_each_index(each.size(),
                 [&](std::size_t k) { each[k].emplace(current.weighted[k], current.spectrum[k]); });
  std::vector<StepProducts> out;
  for (auto& one : each) out.push_back(std::move(*one));
  return out;
}

}  // namespace imunoise
