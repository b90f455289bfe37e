#include "core/process/resonance.h"

#include <cmath>
#include <complex>
#include <numbers>

#include "core/process/exponential_shape.h"

namespace imunoise {
namespace {

using Complex = std::complex<double>;

// C / s² and its derivatives.
struct Amplitude {
  Complex value;
  Complex by_r;
  Complex by_omega;

  Amplitude(double r, double omega) {
    const double sine = std::sin(omega);
    const double loss = (1.0 - r) * (1.0 + r);
    const double spread = loss * loss + 4.0 * r * r * sine * sine;
    const Complex bracket((1.0 + r * r) / loss, -std::cos(omega) / sine);
    value = bracket / spread;
    const double spread_by_r = 4.0 * r * (r * r - std::cos(2.0 * omega));
    const double spread_by_omega = 4.0 * r * r * std::sin(2.0 * omega);
    by_r = (Complex(4.0 * r / (loss * loss), 0.0) - value * spread_by_r) / spread;
    by_omega = (Complex(0.0, 1.0 / (sine * sine)) - value * spread_by_omega) / spread;
  }
};

Complex rate_of(double r, double omega) { return {-std::log(r), -omega}; }  // L = -log z

}  // namespace

std::vector<ParameterInfo> Resonance::parameters() const {
  return {{"sigma2", "variance of the driving noise"},
          {"r", "decay of the oscillation per sample", Dimension::kPurePerSample, 0.05, 1.0 - 1e-4},
          {"omega", "frequency in radians per sample", Dimension::kPurePerSample, 1e-4,
           std::numbers::pi - 1e-4}};
}

Eigen::ArrayXd Resonance::shape(HalfWidths m) const {
  const Amplitude c(r, omega);
  return m.unaryExpr([&](double width) {
    return (c.value * exponential_shape(rate_of(r, omega), width).value).real();
  });
}

Eigen::ArrayXXd Resonance::shape_jacobian(HalfWidths m) const {
  const Amplitude c(r, omega);
  Eigen::ArrayXXd out(m.size(), 2);
  for (Eigen::Index i = 0; i < m.size(); ++i) {
    const auto k = exponential_shape(rate_of(r, omega), m(i));
    const Complex by_rate = c.value * k.value * k.log_derivative;  // L = -ln r - iω
    out(i, 0) = (c.by_r * k.value - by_rate / r).real();
    out(i, 1) = (c.by_omega * k.value - by_rate * Complex(0.0, 1.0)).real();
  }
  return out;
}

double Resonance::spectrum(const Frequency& f) const {
  return spectra(Frequencies(Eigen::ArrayXd::Constant(1, f.cycles)))(0);
}

// |1 - 2r cos ω z + r²z²|², z = e^-iθ, is 4r²(cos θ - (1 + r²)/2r · cos ω)² + (1 - r²)² sin² ω;
// cosines as 1 - 2 sin² of half the angle, whose digits do not cancel.
Resonance::Line Resonance::line() const {
  const double shift = (1.0 - r) * (1.0 - r) / (2.0 * r);  // (1 + r²)/2r - 1
  const double half = std::sin(0.5 * omega);
  const double floor = (1.0 - r) * (1.0 + r) * std::sin(omega);
  return {sigma2, 4.0 * r * r, 2.0 * half * half - shift * std::cos(omega), floor * floor};
}

SumCovariance Resonance::sum_covariance() const {
  const double half = std::sin(0.5 * omega);
  const Complex one_minus_root((1.0 - r) + 2.0 * r * half * half, -r * std::sin(omega));
  return {.exponentials = {{sigma2 * Amplitude(r, omega).value, std::polar(r, omega),
                            -rate_of(r, omega), one_minus_root}}};
}

std::vector<DerivedQuantity> Resonance::derived(Hertz rate) const {
  const double decay = -std::log(r);
  return {{Coefficient::kFrequency, omega * rate.value / (2.0 * std::numbers::pi)},
          {Coefficient::kDampingRatio, decay / std::hypot(decay, omega)},
          {Coefficient::kAmplitude, std::sqrt(sigma2 * Amplitude(r, omega).value.real())}};
}

std::vector<std::vector<double>> Resonance::scan(const Scales& scales) const {
  std::vector<std::vector<double>> out;
  const double slowest = scales.empty() ? 1.0 : 1.0 / static_cast<double>(scales.largest());
  for (const double decay : {0.4, 0.7, 0.85, 0.93, 0.97, 0.99, 0.998}) {
    for (int i = 0; i < 12; ++i) out.push_back({decay, 2.9 - 0.2 * i});
    double angle = 0.5;
    while (angle > std::max(slowest, 1e-3)) {
      if (angle > 0.3 * (1.0 - decay)) out.push_back({decay, angle});
      angle /= 1.4;
    }
  }
  return out;
}

SecondOrderRecursion Resonance::recursion(RandomStream& rng) const {
  const Complex c = sigma2 * Amplitude(r, omega).value;
  return {2.0 * r * std::cos(omega),         -r * r, std::sqrt(sigma2), c.real(),
          (c * std::polar(r, omega)).real(), rng};
}

}  // namespace imunoise
