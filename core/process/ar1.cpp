#include "core/process/ar1.h"

#include <cmath>
#include <numbers>

#include "core/process/exponential_shape.h"

namespace imunoise {
namespace {

struct ShapeAndSlope {
  double shape;
  double slope;  // d shape / dφ
};

// ν/s² = [m(1-φ²) - φ(3 - 4φ^m + φ^2m)] / [2m²(1-φ)²(1-φ²)].
ShapeAndSlope at_scale(double phi, double m) {
  if (phi < 0.5) {
    const double power = std::pow(phi, m);
    // 3 - 4φ^m + φ^2m, where φ^m may be close to 1 when φ is close to -1.
    const double rest = power > 0.0 ? -std::expm1(m * std::log(std::abs(phi))) : 1.0 - power;
    const double bracket = rest * (3.0 - power);
    const double variance = (1.0 - phi) * (1.0 + phi);
    const double top = m * variance - phi * bracket;
    const double top_slope = -2.0 * m * phi - bracket + 4.0 * m * power - 2.0 * m * power * power;
    const double bottom = 2.0 * m * m * (1.0 - phi) * (1.0 - phi) * variance;
    const double bottom_log_slope = -2.0 / (1.0 - phi) - 2.0 * phi / variance;
    return {top / bottom, (top_slope - top * bottom_log_slope) / bottom};
  }
  const double rate = -std::log(phi);
  const ExponentialShape<double> k = exponential_shape(rate, m);
  const double variance = (1.0 - phi) * (1.0 + phi);
  const double shape = k.value / variance;
  // d ln shape / dφ = -(1/φ) d ln K/dL + 2φ/(1-φ²)
  return {shape, shape * (2.0 * phi / variance - k.log_derivative / phi)};
}

}  // namespace

std::vector<ParameterInfo> Ar1::parameters() const {
  return {{"sigma2", "variance of the innovations"},
          {"phi", "correlation of neighbouring samples", Dimension::kPurePerSample, -1.0 + 1e-6,
           1.0 - 1e-12}};
}

Eigen::ArrayXd Ar1::shape(HalfWidths m) const {
  return m.unaryExpr([this](double width) { return at_scale(phi, width).shape; });
}

Eigen::ArrayXXd Ar1::shape_jacobian(HalfWidths m) const {
  return m.unaryExpr([this](double width) { return at_scale(phi, width).slope; });
}

double Ar1::spectrum(const Frequency& f) const {
  return sigma2 / ((1.0 - phi) * (1.0 - phi) + 4.0 * phi * f.half_sine * f.half_sine);
}

SumCovariance Ar1::sum_covariance() const {
  const double variance = sigma2 / ((1.0 - phi) * (1.0 + phi));
  if (phi == 0.0) return {.linear = -0.5 * sigma2};
  const std::complex<double> log_root(std::log(std::abs(phi)), phi < 0.0 ? std::numbers::pi : 0.0);
  return {.exponentials = {{variance, phi, log_root, 1.0 - phi}}};
}

std::vector<DerivedQuantity> Ar1::derived(Hertz rate) const {
  std::vector<DerivedQuantity> out = {
      {Coefficient::kAmplitude, std::sqrt(sigma2 / ((1.0 - phi) * (1.0 + phi)))}};
  if (phi > 0.0)
    out.push_back({Coefficient::kCorrelationTime, -1.0 / (std::log(phi) * rate.value)});
  return out;
}

std::vector<double> scanned_correlation_times(const Scales& scales) {
  std::vector<double> out;
  const double longest = scales.empty() ? 1.0 : 4.0 * static_cast<double>(scales.largest());
  const int steps = static_cast<int>(std::floor(2.0 * std::log2(longest / 0.25)));
  for (int i = 0; i <= steps; ++i) out.push_back(0.25 * std::exp2(0.5 * i));
  out.push_back(1e4 * longest);  // as good as a random walk
  return out;
}

std::vector<std::vector<double>> Ar1::scan(const Scales& scales) const {
  std::vector<std::vector<double>> out = {{-0.9}, {-0.5}, {-0.2}};
  for (const double time : scanned_correlation_times(scales)) {
    out.push_back({std::min(std::exp(-1.0 / time), 1.0 - 1e-12)});
  }
  return out;
}

Ar1::Recursion Ar1::recursion(RandomStream& rng) const {
  const double innovation = std::sqrt(sigma2);
  return {phi, innovation, innovation / std::sqrt((1.0 - phi) * (1.0 + phi)) * rng.normal()};
}

}  // namespace imunoise
