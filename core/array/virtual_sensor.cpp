#include "core/array/virtual_sensor.h"

#include <cmath>

namespace imunoise {
namespace {

constexpr Eigen::Index kMostEnumerated = 16;

// G with the power of a motion that all sensors see. Where Σ c = 1 it adds a constant to cᵀGc and
// moves no minimum; what it leaves singular are combinations of gain zero, which are no sensor.
Eigen::MatrixXd with_motion(const MatrixRef& g) { return g.array() + g.diagonal().mean(); }

// Minimiser of cᵀGc over Σ c = 1.
Eigen::VectorXd unit_gain(const MatrixRef& g) {
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(g.rows());
  const Eigen::VectorXd c = pseudo_inverse(with_motion(g)).matrix * ones;
  return c / c.sum();
}

// The same over c ≥ 0: the non-negative minimiser of cᵀGc - 2·1ᵀc is it, but for its length.
Eigen::VectorXd nonnegative(const MatrixRef& g) {
  const Eigen::MatrixXd moved = with_motion(g);
  const Eigen::VectorXd scale = moved.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * moved * scale.asDiagonal();
  const Eigen::VectorXd c = scale.cwiseProduct(nonnegative_least_squares(scaled, scale));
  return c / c.sum();
}

VirtualSensor of_weights(const MatrixRef& g, Eigen::VectorXd c) {
  const double variance = c.dot(g * c);
  const double gain = c.sum();
  return {std::move(c), gain, variance};
}

VirtualSensor with_signs(const MatrixRef& g, const Eigen::VectorXd& signs) {
  const Eigen::MatrixXd turned = signs.asDiagonal() * g * signs.asDiagonal();
  return of_weights(g, signs.cwiseProduct(nonnegative(turned)));
}

VirtualSensor unit_length(const MatrixRef& g) {
  const Eigen::Index n = g.rows();
  Eigen::VectorXd signs = Eigen::VectorXd::Ones(n);
  VirtualSensor best = with_signs(g, signs);
  // A sensor that is independent of the others may have either sign: the larger gain is taken.
  const auto better = [&](const VirtualSensor& other) {
    const double gap = other.variance / best.variance - 1.0;
    return gap < -1e-12 || (gap < 1e-12 && std::abs(other.gain) > std::abs(best.gain) + 1e-9);
  };
  if (n <= kMostEnumerated) {  // c and -c are the same: the first sign is free
    for (std::size_t pattern = 1; pattern < std::size_t{1} << static_cast<unsigned>(n - 1);
         ++pattern) {
      for (Eigen::Index i = 1; i < n; ++i) {
        signs(i) = (pattern >> static_cast<unsigned>(i - 1)) % 2 == 1 ? -1.0 : 1.0;
      }
      const VirtualSensor one = with_signs(g, signs);
      if (better(one)) best = one;
    }
  } else {
    for (bool moved = true; moved;) {
      moved = false;
      for (Eigen::Index i = 0; i < n; ++i) {
        signs(i) = -signs(i);
        const VirtualSensor one = with_signs(g, signs);
        if (better(one)) {
          best = one;
          moved = true;
        } else {
          signs(i) = -signs(i);
        }
      }
    }
  }
  if (best.gain < 0.0) best = of_weights(g, -best.weights);
  return best;
}

}  // namespace

Eigen::MatrixXd weighted_covariance(const std::vector<Eigen::MatrixXd>& covariance,
                                    const Eigen::VectorXd& scale_weights) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(covariance.front().rows(), covariance.front().cols());
  for (std::size_t j = 0; j < covariance.size(); ++j) {
    out += scale_weights(static_cast<Eigen::Index>(j)) * covariance[j];
  }
  return out;
}

VirtualSensor best_virtual_sensor(const MatrixRef& weighted, WeightRule rule) {
  switch (rule) {
    case WeightRule::kUnitGain:
      return of_weights(weighted, unit_gain(weighted));
    case WeightRule::kNonnegative:
      return of_weights(weighted, nonnegative(weighted));
    case WeightRule::kUnitLength:
      break;
  }
  return unit_length(weighted);
}

Eigen::MatrixXd weight_covariance(const VirtualSensor& sensor, const MatrixRef& weighted,
                                  const Eigen::VectorXd& scale_weights,
                                  const Eigen::MatrixXd& moments) {
  const Eigen::Index n = weighted.rows();
  std::vector<Eigen::Index> used;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (sensor.weights(i) != 0.0) used.push_back(i);
  }
  // c = G⁻¹1 / 1ᵀG⁻¹1, so dc = -(I - c 1ᵀ) G⁻¹ dG c, on the sensors in use.
  const auto size = static_cast<Eigen::Index>(used.size());
  Eigen::MatrixXd g(size, size);
  Eigen::VectorXd c(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    c(i) = sensor.weights(used[static_cast<std::size_t>(i)]);
    for (Eigen::Index k = 0; k < size; ++k) {
      g(i, k) = weighted(used[static_cast<std::size_t>(i)], used[static_cast<std::size_t>(k)]);
    }
  }
  const Eigen::MatrixXd project =
      -(Eigen::MatrixXd::Identity(size, size) - c * Eigen::RowVectorXd::Ones(size)) *
      pseudo_inverse(with_motion(g)).matrix;
  const Pairs pairs = all_pairs(n);
  const Eigen::Index scales = scale_weights.size();
  Eigen::MatrixXd slope =
      Eigen::MatrixXd::Zero(n, scales * static_cast<Eigen::Index>(pairs.size()));
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    Eigen::VectorXd moved = Eigen::VectorXd::Zero(n);  // dG c, per unit of the pair's entry
    moved(pairs[p].a) += sensor.weights(pairs[p].b);
    if (pairs[p].a != pairs[p].b) moved(pairs[p].b) += sensor.weights(pairs[p].a);
    Eigen::VectorXd moved_used(size);
    for (Eigen::Index i = 0; i < size; ++i) {
      moved_used(i) = moved(used[static_cast<std::size_t>(i)]);
    }
    const Eigen::VectorXd change = project * moved_used;
    for (Eigen::Index i = 0; i < size; ++i) {
      slope.row(used[static_cast<std::size_t>(i)])
          .segment(static_cast<Eigen::Index>(p) * scales, scales) =
          change(i) * scale_weights.transpose();
    }
  }
  return slope * moments * slope.transpose();
}

Eigen::ArrayXd gain_over_mean(const std::vector<Eigen::MatrixXd>& covariance,
                              const Eigen::VectorXd& weights) {
  const Eigen::VectorXd equal =
      Eigen::VectorXd::Constant(weights.size(), 1.0 / static_cast<double>(weights.size()));
  Eigen::ArrayXd out(static_cast<Eigen::Index>(covariance.size()));
  for (std::size_t j = 0; j < covariance.size(); ++j) {
    const double of_mean = equal.dot(covariance[j] * equal);
    out(static_cast<Eigen::Index>(j)) =
        of_mean > 0.0 ? weights.dot(covariance[j] * weights) / of_mean : 1.0;
  }
  return out;
}

}  // namespace imunoise
