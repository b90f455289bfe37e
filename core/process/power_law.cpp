#include "core/process/power_law.h"

#include <array>
#include <cmath>
#include <numbers>

namespace imunoise {
namespace {

constexpr std::size_t kParts = 20;
constexpr double kRatio = 4.0;  // of neighbouring times

// Rates of the Markov processes, per sample: 4, 1, 1/4 … 1.5e-11.
const std::array<double, kParts>& rates() {
  static const std::array<double, kParts> kRates = [] {
    std::array<double, kParts> out{};
    double rate = kRatio;
    for (double& one : out) {
      one = rate;
      rate /= kRatio;
    }
    return out;
  }();
  return kRates;
}

// K and d ln K / dα of K Σ λ^(2-α)/(λ² + ω²) ≈ A² ω^-α, by ∫ λ^(2-α)/(λ² + ω²) dlnλ =
// ω^-α π/(2 sin(πα/2)).
struct Norm {
  double value;
  double log_slope;
  explicit Norm(double slope) {
    const double angle = 0.5 * std::numbers::pi * slope;
    value = std::log(kRatio) * 2.0 / std::numbers::pi * std::sin(angle);
    log_slope = 0.5 * std::numbers::pi / std::tan(angle);
  }
};

// The part of one rate; its spectrum is that of K λ^-α at frequency zero.
Ar1 part_of(const PowerLaw& of, double rate) {
  const double loss = -std::expm1(-rate);
  return {of.a2 * Norm(of.slope).value * std::pow(rate, -of.slope) * loss * loss, 1.0 - loss};
}

}  // namespace

std::vector<ParameterInfo> PowerLaw::parameters() const {
  return {{"a2", "square of the coefficient A: two-sided spectrum A²/(2πf)^slope"},
          {"slope", "exponent by which power falls with frequency", Dimension::kPurePerSample, 0.05,
           1.95}};
}

std::vector<Ar1> PowerLaw::parts() const {
  std::vector<Ar1> out;
  for (const double rate : rates()) out.push_back(part_of(*this, rate));
  return out;
}

Eigen::ArrayXd PowerLaw::shape(HalfWidths m) const {
  Eigen::ArrayXd out = Eigen::ArrayXd::Zero(m.size());
  for (const Ar1& part : PowerLaw{1.0, slope}.parts()) out += part.sigma2 * part.shape(m);
  return out;
}

Eigen::ArrayXXd PowerLaw::shape_jacobian(HalfWidths m) const {
  const PowerLaw unit{1.0, slope};
  const double norm = Norm(slope).log_slope;
  Eigen::ArrayXXd out = Eigen::ArrayXXd::Zero(m.size(), 1);
  for (const double rate : rates()) {
    const Ar1 part = part_of(unit, rate);
    out.col(0) += part.sigma2 * (norm - std::log(rate)) * part.shape(m);
  }
  return out;
}

double PowerLaw::spectrum(const Frequency& f) const {
  return spectra(Frequencies(Eigen::ArrayXd::Constant(1, f.cycles)))(0);
}

Eigen::ArrayXd PowerLaw::spectra(const Frequencies& f) const {
  const Eigen::ArrayXd square = 4.0 * f.half_sines().square();
  Eigen::ArrayXd out = Eigen::ArrayXd::Zero(f.size());
  for (const Ar1& part : parts()) {
    const double loss = 1.0 - part.phi;
    out += part.sigma2 / (loss * loss + part.phi * square);
  }
  return out;
}

SumCovariance PowerLaw::sum_covariance() const {
  SumCovariance out;
  for (const Ar1& part : parts()) out += part.sum_covariance();
  return out;
}

std::vector<std::vector<double>> PowerLaw::scan(const Scales&) const {
  return {{0.3}, {0.6}, {0.9}, {1.2}, {1.5}, {1.8}};
}

double PowerLaw::Recursion::next(RandomStream& rng) {
  double out = 0.0;
  for (Ar1::Recursion& one : parts_) out += one.next(rng);
  return out;
}

PowerLaw::Recursion PowerLaw::recursion(RandomStream& rng) const {
  Recursion out;
  for (const Ar1& part : parts()) out.parts_.push_back(part.recursion(rng));
  return out;
}

}  // namespace imunoise
