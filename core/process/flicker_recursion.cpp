#include "core/process/flicker_recursion.h"

#include <cmath>
#include <numbers>

#include "core/support/linear_algebra.h"

namespace imunoise {
namespace {

// Exponents u of the bank: times from 3e-4 to 6e14 samples.
constexpr int kShortest = -8;
constexpr int kLongest = 34;

}  // namespace

FlickerRecursion::FlickerRecursion(double b2, RandomStream& rng) : sigma_(std::sqrt(b2)) {
  constexpr Eigen::Index kCount = kLongest - kShortest + 1;
  Eigen::ArrayXd loss(kCount);  // 1 - x, which is all that is left of x where memory is long
  for (Eigen::Index i = 0; i < kCount; ++i) {
    loss[i] = 1.0 / (1.0 + std::exp(static_cast<double>(kShortest + i)));
    const double decay = 1.0 - loss[i];
    filters_.push_back({std::sqrt(decay * loss[i]) / std::numbers::pi, decay, 0.0});
    direct_ -= filters_.back().weight;
  }
  // The past that all filters share: states s_i = Σ_j x_i^j e_j have the covariance
  // 1 / (1 - x_i x_k), here drawn with unit variances.
  const Eigen::ArrayXd deviation = 1.0 / (loss * (2.0 - loss)).sqrt();
  Eigen::MatrixXd correlation(kCount, kCount);
  for (Eigen::Index i = 0; i < kCount; ++i) {
    for (Eigen::Index k = 0; k < kCount; ++k) {
      const double distance = loss[i] + loss[k] - loss[i] * loss[k];
      correlation(i, k) = 1.0 / (distance * deviation[i] * deviation[k]);
    }
  }
  Eigen::VectorXd draws(kCount);
  for (double& draw : draws) draw = rng.normal();
  const Eigen::VectorXd past = square_root(correlation) * draws;
  for (Eigen::Index i = 0; i < kCount; ++i) {
    filters_[static_cast<std::size_t>(i)].state = sigma_ * deviation[i] * past[i];
  }
}

double FlickerRecursion::next(RandomStream& rng) {
  const double input = sigma_ * rng.normal();
  double out = direct_ * input;
  for (Filter& filter : filters_) {
    filter.state = filter.decay * filter.state + input;
    out += filter.weight * filter.state;
  }
  return out;
}

std::vector<double> FlickerRecursion::impulse_response(std::size_t n) const {
  std::vector<double> out(n);
  if (n > 0) out.front() = direct_;
  for (const Filter& filter : filters_) {
    double power = filter.weight;
    for (double& h : out) {
      h += power;
      power *= filter.decay;
    }
  }
  return out;
}

}  // namespace imunoise
