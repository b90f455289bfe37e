#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "core/process/ar1.h"
#include "core/process/contract.h"
#include "core/process/exponential_shape.h"
#include "core/process/second_order_recursion.h"

namespace imunoise {

/// Second-order autoregression x_t = φ₁ x_{t-1} + φ₂ x_{t-2} + e_t, var e = s², with any stationary
/// roots: real, complex or equal. Its parameters are the partial autocorrelations ρ₁ = φ₁/(1 - φ₂)
/// and φ₂ (Barndorff-Nielsen & Schou 1973): every pair in (-1, 1)² is stationary, and no two pairs
/// are the same noise. With the roots z₁, z₂ of z² - φ₁z - φ₂ the autocovariance is
/// γ(h) = s²/(1 + φ₂) · G[z₁, z₂], the divided difference of G(z) = z^(h+1) / (1 - z²).
struct Ar2 {
  double sigma2 = 1.0;  ///< s², of the innovations
  double rho1 = 0.5;
  double phi2 = 0.25;

  static constexpr ProcessInfo kInfo{
      "AR2", "second-order autoregression",
      "White noise through two filters of first order in a row, or through a resonance: a slow "
      "disturbance with inertia, such as temperature behind a housing."};
  friend bool operator==(const Ar2&, const Ar2&) = default;

  std::vector<ParameterInfo> parameters() const {
    return {{"sigma2", "variance of the innovations"},
            {"rho1", "correlation of neighbouring samples", Dimension::kPurePerSample, -1.0 + 1e-6,
             1.0 - 1e-12},
            {"phi2", "partial correlation of samples two apart", Dimension::kPurePerSample,
             -1.0 + 1e-8, 1.0 - 1e-6}};
  }
  std::vector<double> values() const { return {sigma2, rho1, phi2}; }
  void set_values(std::span<const double> v) {
    sigma2 = v[0];
    rho1 = v[1];
    phi2 = v[2];
  }
  /// φ₁.
  double phi1() const { return rho1 * (1.0 - phi2); }
  /// γ(0).
  double variance() const {
    return sigma2 / ((1.0 - rho1) * (1.0 + rho1) * (1.0 - phi2) * (1.0 + phi2));
  }

  Eigen::ArrayXd shape(HalfWidths m) const {
    const std::vector<Node> all = nodes();
    return m.unaryExpr([&](double width) {
      double sum = 0.0;
      for (const Node& at : all)
        sum += (at.weight * exponential_shape(at.rate, width).value).real();
      return sum / (1.0 + phi2);
    });
  }

  Eigen::ArrayXXd shape_jacobian(HalfWidths m) const {
    const std::vector<Node> all = nodes();
    Eigen::ArrayXXd out(m.size(), 2);
    for (Eigen::Index i = 0; i < m.size(); ++i) {
      double value = 0.0;
      double by_rho = 0.0;
      double by_phi = 0.0;
      for (const Node& at : all) {
        const auto k = exponential_shape(at.rate, m(i));
        const Slope slope = slope_at(at, k.value, k.log_derivative);
        value += (at.weight * k.value).real();
        by_rho += slope.by_rho.real();
        by_phi += slope.by_phi.real();
      }
      out(i, 0) = by_rho / (1.0 + phi2);
      out(i, 1) = (by_phi - value / (1.0 + phi2)) / (1.0 + phi2);
    }
    return out;
  }

  /// |1 - φ₁e^{-iω} - φ₂e^{-2iω}|² = (1 - φ₂)²(cos ω - ρ₁)² + (1 + φ₂)² sin² ω.
  double spectrum(const Frequency& f) const {
    const double half = f.half_sine;
    const double even = (1.0 - phi2) * ((1.0 - rho1) - 2.0 * half * half);
    const double odd = (1.0 + phi2) * 2.0 * half * f.half_cosine;
    return sigma2 / (even * even + odd * odd);
  }

  SumCovariance sum_covariance() const {
    SumCovariance out;
    for (const Node& at : nodes()) {
      out.exponentials.push_back(
          {sigma2 / (1.0 + phi2) * at.weight, at.root, -at.rate, at.one_minus});
    }
    return out;
  }

  std::vector<DerivedQuantity> derived(Hertz rate) const {
    std::vector<DerivedQuantity> out = {{Coefficient::kAmplitude, std::sqrt(variance())}};
    const Roots roots(*this);
    if (roots.discriminant < 0.0) {
      const Node ringing = node(roots.one_minus[0], roots.one_plus[0]);
      const double angle = std::abs(ringing.rate.imag());
      out.push_back({Coefficient::kFrequency, angle * rate.value / (2.0 * std::numbers::pi)});
      out.push_back({Coefficient::kDampingRatio, ringing.rate.real() / std::abs(ringing.rate)});
    } else if (roots.one_minus[0].real() < 1.0) {
      out.push_back({Coefficient::kCorrelationTime,
                     -1.0 / (std::log1p(-roots.one_minus[0].real()) * rate.value)});
    }
    return out;
  }

  std::vector<std::vector<double>> scan(const Scales& scales) const {
    std::vector<std::vector<double>> out;
    const auto add = [&](Complex u, Complex v) {  // 1 - root of both
      const double product = ((1.0 - u) * (1.0 - v)).real();
      const double to_one = (u * v).real() / (1.0 + product);  // 1 - ρ₁
      out.push_back({std::clamp(1.0 - to_one, -1.0 + 1e-6, 1.0 - 1e-12), -product});
    };
    constexpr std::size_t kStride = 4;  // two octaves
    std::vector<double> real = {1.5};
    const std::vector<double> times = scanned_correlation_times(scales);
    for (std::size_t i = 0; i < times.size(); i += kStride)
      real.push_back(-std::expm1(-1.0 / times[i]));
    for (std::size_t i = 0; i < real.size(); ++i) {
      for (std::size_t k = 0; k <= i; ++k) add(real[i], real[k]);
    }
    const double slowest = scales.empty() ? 1.0 : 1.0 / static_cast<double>(scales.largest());
    for (const double decay : {0.4, 0.7, 0.85, 0.93, 0.97, 0.99, 0.998}) {
      for (double angle = 2.9; angle > std::max({slowest, 1e-3, 0.3 * (1.0 - decay)});
           angle = std::max(angle - 0.4, angle / 1.6)) {
        const Complex root = std::polar(decay, angle);
        add(1.0 - root, 1.0 - std::conj(root));
      }
    }
    return out;
  }

  SecondOrderRecursion recursion(RandomStream& rng) const {
    return {phi1(), phi2, std::sqrt(sigma2), variance(), rho1 * variance(), rng};
  }

 private:
  using Complex = std::complex<double>;

  // 1 - z and 1 + z of both roots, which keep their digits where a root is close to 1 or -1; the
  // larger root first, or the upper of a complex pair.
  struct Roots {
    double discriminant;  // (z₁ - z₂)²
    double centre_minus;  // of 1 - z
    double centre_plus;   // of 1 + z
    std::array<Complex, 2> one_minus;
    std::array<Complex, 2> one_plus;

    explicit Roots(const Ar2& of) {
      const double b = 1.0 + of.phi2;
      const double c = 1.0 - of.phi2;
      const double minus = (1.0 - of.rho1) * c;  // (1 - z₁)(1 - z₂)
      const double plus = (1.0 + of.rho1) * c;   // (1 + z₁)(1 + z₂)
      discriminant = b * b - minus * plus;
      centre_minus = 0.5 * (b + minus);
      centre_plus = 0.5 * (b + plus);
      const double reach = 0.5 * std::sqrt(std::abs(discriminant));
      if (discriminant < 0.0) {
        one_minus = {Complex(centre_minus, -reach), Complex(centre_minus, reach)};
        one_plus = {Complex(centre_plus, reach), Complex(centre_plus, -reach)};
      } else {
        one_minus = {minus / (centre_minus + reach), centre_minus + reach};
        one_plus = {centre_plus + reach, plus / (centre_plus + reach)};
      }
    }
  };

  // A place z at which G is taken, and with which weight: (1 + φ₂) γ(h) / s² = Re Σ weight · z^h.
  struct Node {
    Complex root;
    Complex one_minus;
    Complex rate;    // -log root
    Complex source;  // z / (1 - z²)
    Complex weight{};
    Complex once{};   // of G in the divided difference of third order, G[z₁, z₁, z₂, z₂]
    Complex twice{};  // of dG/dz there
  };

  static Node node(Complex one_minus, Complex one_plus) {
    Node out;
    out.one_minus = one_minus;
    out.root = 1.0 - one_minus;
    if (std::abs(out.root) < 1e-30) out.root = 1e-30;  // one root of an AR1 is zero
    const double log_size = std::abs(one_minus) < 0.5
                                ? 0.5 * std::log1p(std::norm(one_minus) - 2.0 * one_minus.real())
                                : std::log(std::abs(out.root));
    out.rate = {-log_size, -std::arg(out.root)};
    out.source = out.root / (one_minus * one_plus);
    return out;
  }

  // Divided differences as sums over places: the roots themselves where they are well apart; a
  // circle around both where they are close or equal (Cauchy's formula, by the trapezoidal rule).
  std::vector<Node> nodes() const {
    constexpr double kClose = 0.03;  // of the distance to ±1, where G has its poles
    const Roots roots(*this);
    const double clearance = std::min(roots.centre_minus, roots.centre_plus);
    std::vector<Node> out;
    if (0.5 * std::sqrt(std::abs(roots.discriminant)) > kClose * clearance) {
      const bool pair = roots.discriminant < 0.0;
      const double root = std::sqrt(std::abs(roots.discriminant));
      const Complex gap = pair ? Complex(0.0, root) : Complex(root);
      for (const std::size_t i : {0U, 1U}) {
        if (pair && i == 1) break;  // the conjugate: twice the real part
        const Complex apart = i == 0 ? gap : -gap;
        const double times = pair ? 2.0 : 1.0;
        Node one = node(roots.one_minus[i], roots.one_plus[i]);
        one.weight = times * one.source / apart;
        one.once = -2.0 * times / (apart * apart * apart);
        one.twice = times / (apart * apart);
        out.push_back(one);
      }
      return out;
    }
    constexpr int kHalf = 10;                             // of the places on the circle
    const double radius = std::sqrt(kClose) * clearance;  // error kClose^10
    for (int k = 0; k < kHalf; ++k) {
      const Complex away = std::polar(radius, std::numbers::pi * (k + 0.5) / kHalf);
      const Complex polynomial = away * away - 0.25 * roots.discriminant;
      Node one = node(roots.centre_minus - away, roots.centre_plus + away);
      one.weight = one.source * away / (static_cast<double>(kHalf) * polynomial);
      one.once = away / (static_cast<double>(kHalf) * polynomial * polynomial);
      out.push_back(one);
    }
    return out;
  }

  // d/dρ₁ and d/dφ₂ of (1 + φ₂) ν / s²: with d/dφ₁ = (zG)[z₁, z₁, z₂, z₂] and
  // d/dφ₂ = G[z₁, z₁, z₂, z₂] they are of (1 - φ₂) z G and (1 - ρ₁z) G.
  struct Slope {
    Complex by_rho;
    Complex by_phi;
  };
  Slope slope_at(const Node& at, Complex k, Complex log_derivative) const {
    const Complex g = at.source * k;
    const Complex to_one = at.source / at.root;  // 1 / (1 - z²)
    const Complex g_slope =
        k * to_one * ((1.0 + at.root * at.root) * to_one - log_derivative);  // dG/dz
    const auto of = [&](Complex factor, double factor_slope) {
      return at.once * factor * g + at.twice * (factor * g_slope + factor_slope * g);
    };
    return {of((1.0 - phi2) * at.root, 1.0 - phi2), of((1.0 - rho1) + rho1 * at.one_minus, -rho1)};
  }
};

}  // namespace imunoise
