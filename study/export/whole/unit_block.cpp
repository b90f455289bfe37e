#include "study/export/whole/unit_block.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace imunoise::study {
namespace {

constexpr std::size_t kMostTaps = 64;

UnitBlock first_order(double phi, double innovation, double stationary) {
  UnitBlock out;
  out.phi = Eigen::MatrixXd::Constant(1, 1, phi);
  out.q = Eigen::MatrixXd::Constant(1, 1, innovation);
  out.h = Eigen::RowVectorXd::Ones(1);
  out.p0 = Eigen::MatrixXd::Constant(1, 1, stationary);
  return out;
}

// x_t = a x_{t-1} + b x_{t-2} + e_t, var e = 1; states x_t and x_{t-1}.
UnitBlock second_order(double a, double b, double stationary, double correlation) {
  UnitBlock out;
  out.phi.resize(2, 2);
  out.phi << a, b, 1.0, 0.0;
  out.q = Eigen::MatrixXd::Zero(2, 2);
  out.q(0, 0) = 1.0;
  out.h.resize(2);
  out.h << 1.0, 0.0;
  out.p0.resize(2, 2);
  out.p0 << 1.0, correlation, correlation, 1.0;
  out.p0 *= stationary;
  return out;
}

// Σ taps_k e_{t-k}, var e = 1; states e_t, e_{t-1}, ...
Result<UnitBlock> delay_line(const std::vector<double>& taps) {
  if (taps.size() > kMostTaps)
    return fail(fmt::format("a filter of {} taps would need as many states; at most {} are written",
                            taps.size(), kMostTaps));
  const auto n = static_cast<Eigen::Index>(taps.size());
  UnitBlock out;
  out.phi = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 1; i < n; ++i) out.phi(i, i - 1) = 1.0;
  out.q = Eigen::MatrixXd::Zero(n, n);
  out.q(0, 0) = 1.0;
  out.h = Eigen::Map<const Eigen::RowVectorXd>(taps.data(), n);
  out.p0 = Eigen::MatrixXd::Identity(n, n);
  return out;
}

// 1/f as Markov processes whose variances per logarithm of time are equal: with B² ln(ratio)/π
// each, the sum of 2σ²T/(1 + (2πfT)²) is B²/(2πf) (van der Ziel 1950), with a ripple below 1 % at
// ratio 4.
UnitBlock flicker_bank() {
  constexpr double kRatio = 4.0;
  constexpr double kShortest = 0.5;  // samples
  constexpr double kLongest = 1e7;
  const auto n =
      static_cast<Eigen::Index>(std::ceil(std::log(kLongest / kShortest) / std::log(kRatio))) + 1;
  const double variance = std::log(kRatio) / std::numbers::pi;
  UnitBlock out;
  out.phi = Eigen::MatrixXd::Zero(n, n);
  out.q = Eigen::MatrixXd::Zero(n, n);
  out.h = Eigen::RowVectorXd::Ones(n);
  out.p0 = variance * Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double time = kShortest * std::pow(kRatio, static_cast<double>(i));
    out.phi(i, i) = std::exp(-1.0 / time);
    out.q(i, i) = -variance * std::expm1(-2.0 / time);
  }
  return out;
}

// Independent processes of given powers, one below the other.
struct Together {
  UnitBlock block;

  void add(const UnitBlock& one, double power) {
    const Eigen::Index before = block.phi.rows();
    const Eigen::Index n = one.phi.rows();
    for (Eigen::MatrixXd* const m : {&block.phi, &block.q, &block.p0}) {
      m->conservativeResizeLike(Eigen::MatrixXd::Zero(before + n, before + n));
    }
    block.h.conservativeResizeLike(Eigen::RowVectorXd::Zero(before + n));
    block.phi.bottomRightCorner(n, n) = one.phi;
    block.q.bottomRightCorner(n, n) = power * one.q;
    block.p0.bottomRightCorner(n, n) = power * one.p0;
    block.h.tail(n) = one.h;
  }
};

struct MakeBlock {
  Result<UnitBlock> operator()(const WhiteNoise&) const {
    UnitBlock out;
    out.r = 1.0;
    return out;
  }
  // The difference of neighbouring rounding errors.
  Result<UnitBlock> operator()(const QuantisationNoise&) const { return delay_line({1.0, -1.0}); }
  Result<UnitBlock> operator()(const RandomWalk&) const { return first_order(1.0, 1.0, 0.0); }
  Result<UnitBlock> operator()(const RateRamp&) const { return UnitBlock{}; }
  Result<UnitBlock> operator()(const Ar1& of) const {
    return first_order(of.phi, 1.0, 1.0 / ((1.0 - of.phi) * (1.0 + of.phi)));
  }
  Result<UnitBlock> operator()(const GaussMarkov& of) const {
    const Ar1 unit = GaussMarkov{1.0, of.tc, of.rate}.discrete();
    return first_order(unit.phi, unit.sigma2, 1.0);
  }
  Result<UnitBlock> operator()(const Ar2& of) const {
    return second_order(of.phi1(), of.phi2, Ar2{1.0, of.rho1, of.phi2}.variance(), of.rho1);
  }
  Result<UnitBlock> operator()(const Resonance& of) const {
    const double a = 2.0 * of.r * std::cos(of.omega);
    const double b = -of.r * of.r;
    const Ar2 same{1.0, a / (1.0 - b), b};
    return second_order(a, b, same.variance(), same.rho1);
  }
  Result<UnitBlock> operator()(const MovingAverage& of) const {
    std::vector<double> taps = {1.0};
    taps.insert(taps.end(), of.theta.begin(), of.theta.end());
    return delay_line(taps);
  }
  Result<UnitBlock> operator()(const MovingAverageFilter& of) const {
    return delay_line(boxcar_taps(of.length));
  }
  Result<UnitBlock> operator()(const BartlettFilter& of) const {
    return delay_line(bartlett_taps(of.length));
  }
  template <class Form>
  Result<UnitBlock> operator()(const LowPass<Form>& of) const {
    const LinearSystem system = of.system();
    return UnitBlock{system.transition, system.input * system.input.transpose(), system.output,
                     system.stationary};
  }
  Result<UnitBlock> operator()(const Flicker&) const { return flicker_bank(); }
  Result<UnitBlock> operator()(const Voigt& of) const {
    Together out;
    for (const Resonance& one : Voigt{1.0, of.r, of.omega, of.spread}.parts())
      out.add(*(*this)(one), one.sigma2);
    return out.block;
  }
  Result<UnitBlock> operator()(const PowerLaw& of) const {
    Together out;
    for (const Ar1& one : PowerLaw{1.0, of.slope}.parts()) out.add(*(*this)(one), one.sigma2);
    return out.block;
  }
};

}  // namespace

Result<UnitBlock> unit_block(const Process& process) { return std::visit(MakeBlock{}, process); }

}  // namespace imunoise::study
