#include "core/wavelet/discrete_quadrature.h"

#include <cassert>
#include <cmath>
#include <numbers>
#include <unordered_map>

namespace imunoise {
namespace {

constexpr int kOrder = DiscreteRule::kOrder;

// Monic polynomials orthogonal on -h, -h+1 .. h, h = (N-1)/2: p_{k+1} = x p_k - b_k p_{k-1},
// b_k = k²(N² - k²) / (4(4k² - 1)), Σ p_k² = N Π b (Gautschi 2004, section 1.4).
struct Recurrence {
  std::array<double, kOrder> b{};
  double points;

  explicit Recurrence(std::int64_t n) : points(static_cast<double>(n)) {
    for (int k = 1; k < kOrder; ++k) {
      const double kk = static_cast<double>(k) * k;
      b[static_cast<std::size_t>(k)] = kk * (points * points - kk) / (4.0 * (4.0 * kk - 1.0));
    }
  }

  struct Value {
    double last;        // p_n(x), scaled
    double derivative;  // p_n'(x), scaled alike
    double norm;        // Σ_{k<n} p_k(x)² / Σ p_k²
  };

  // Orthonormal form, which stays of order one.
  Value at(double x) const {
    double before = 0.0;
    double now = 1.0 / std::sqrt(points);
    double slope_before = 0.0;
    double slope = 0.0;
    double norm = now * now;
    double root = 0.0;
    for (int k = 0; k < kOrder; ++k) {
      const double next_root = k + 1 < kOrder ? std::sqrt(b[static_cast<std::size_t>(k) + 1]) : 1.0;
      const double next = (x * now - root * before) / next_root;
      const double next_slope = (now + x * slope - root * slope_before) / next_root;
      before = now;
      slope_before = slope;
      now = next;
      slope = next_slope;
      root = next_root;
      if (k + 1 < kOrder) norm += now * now;
    }
    return {now, slope, norm};
  }
};

DiscreteRule made(std::int64_t points) {
  assert(points >= DiscreteRule::kLeastPoints);
  const Recurrence recurrence(points);
  const double half = 0.5 * recurrence.points;
  DiscreteRule out{};
  for (int i = 0; i < kOrder; ++i) {
    // Newton's method from the roots of Legendre's polynomial, which the Gram polynomial tends to.
    double x = -half * std::cos(std::numbers::pi * (i + 0.75) / (kOrder + 0.5));
    Recurrence::Value value = recurrence.at(x);
    for (int step = 0; step < 12; ++step) {
      const double move = value.last / value.derivative;
      x -= move;
      value = recurrence.at(x);
      if (std::abs(move) < 1e-14 * half) break;
    }
    out.nodes[static_cast<std::size_t>(i)] = x + 0.5 * (recurrence.points - 1.0);
    out.weights[static_cast<std::size_t>(i)] = 1.0 / value.norm;
  }
  return out;
}

}  // namespace

DiscreteRule discrete_rule(std::int64_t points) {
  constexpr std::size_t kMostKept = 512;
  thread_local std::unordered_map<std::int64_t, DiscreteRule> kept;
  if (const auto found = kept.find(points); found != kept.end()) return found->second;
  if (kept.size() == kMostKept) kept.clear();
  return kept.emplace(points, made(points)).first->second;
}

}  // namespace imunoise
