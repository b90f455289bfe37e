#pragma once

#include <array>
#include <cstdint>

namespace imunoise {

/// Nodes and weights with Σ_{s=0}^{N-1} f(s) = Σ_i weight_i f(node_i), exact for polynomials up to
/// degree 2·kOrder - 1: Gauss quadrature for the discrete uniform measure (Gram polynomials).
struct DiscreteRule {
  static constexpr int kOrder = 12;
  static constexpr std::int64_t kLeastPoints = 36;  ///< fewer are summed one by one
  std::array<double, kOrder> nodes;
  std::array<double, kOrder> weights;
};

/// The rule for N points, N ≥ kLeastPoints. The thread's last few hundred are kept.
DiscreteRule discrete_rule(std::int64_t points);

}  // namespace imunoise
