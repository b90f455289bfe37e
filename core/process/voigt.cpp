#include "core/process/voigt.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace imunoise {
namespace {

// A damped oscillation of the comb.
struct Tooth {
  double place = 0.0;   // x, in standard deviations of the spread
  double weight = 0.0;  // of the driving variance
};

constexpr std::size_t kTeeth = 15;

const std::array<Tooth, kTeeth>& comb() {
  static const std::array<Tooth, kTeeth> kComb = [] {
    constexpr double kStep = 0.4;
    std::array<Tooth, kTeeth> out{};
    double total = 0.0;
    for (std::size_t j = 0; j < kTeeth; ++j) {
      out[j].place = kStep * (static_cast<double>(j) - 0.5 * (kTeeth - 1));
      out[j].weight = std::exp(-0.5 * out[j].place * out[j].place);
      total += out[j].weight;
    }
    for (Tooth& tooth : out) tooth.weight /= total;
    return out;
  }();
  return kComb;
}

// The oscillation of a tooth. A frequency beyond 0 or π is its mirror image; at these two the
// amplitude has no closed form.
struct Oscillation {
  Resonance process;
  double by_omega = 1.0;  // d(its frequency)/dω

  Oscillation(const Voigt& of, const Tooth& tooth) {
    constexpr double kPi = std::numbers::pi;
    constexpr double kEnd = 1e-6;
    double at = of.omega + of.spread * tooth.place;
    if (at < 0.0 || at > kPi) {
      at = at < 0.0 ? -at : 2.0 * kPi - at;
      by_omega = -1.0;
    }
    process = {of.sigma2 * tooth.weight, of.r, std::clamp(at, kEnd, kPi - kEnd)};
  }
};

}  // namespace

std::vector<ParameterInfo> Voigt::parameters() const {
  std::vector<ParameterInfo> out = Resonance{}.parameters();
  out[0].meaning = "variance of all driving noise";
  out[1].meaning = "decay of each oscillation per sample";
  out[2].meaning = "middle frequency in radians per sample";
  out.push_back({"spread", "standard deviation of the frequency in radians per sample",
                 Dimension::kPurePerSample, 1e-4, 1.0, true});
  return out;
}

std::vector<Resonance> Voigt::parts() const {
  std::vector<Resonance> out;
  for (const Tooth& tooth : comb()) out.push_back(Oscillation(*this, tooth).process);
  return out;
}

Eigen::ArrayXd Voigt::shape(HalfWidths m) const {
  Eigen::ArrayXd out = Eigen::ArrayXd::Zero(m.size());
  for (const Tooth& tooth : comb())
    out += tooth.weight * Oscillation(*this, tooth).process.shape(m);
  return out;
}

Eigen::ArrayXXd Voigt::shape_jacobian(HalfWidths m) const {
  Eigen::ArrayXXd out = Eigen::ArrayXXd::Zero(m.size(), 3);
  for (const Tooth& tooth : comb()) {
    const Oscillation one(*this, tooth);
    const Eigen::ArrayXXd slope = tooth.weight * one.process.shape_jacobian(m);
    out.col(0) += slope.col(0);
    out.col(1) += one.by_omega * slope.col(1);
    out.col(2) += one.by_omega * tooth.place * slope.col(1);
  }
  return out;
}

double Voigt::spectrum(const Frequency& f) const {
  return spectra(Frequencies(Eigen::ArrayXd::Constant(1, f.cycles)))(0);
}

// Three lines share a division, which costs as much as they do otherwise; a block of frequencies
// stays in registers.
Eigen::ArrayXd Voigt::spectra(const Frequencies& f) const {
  using Block = Eigen::Array<double, 8, 1>;
  static_assert(kTeeth % 3 == 0);
  std::array<Resonance::Line, kTeeth> lines;
  for (std::size_t j = 0; j < kTeeth; ++j) lines[j] = Oscillation(*this, comb()[j]).process.line();
  const auto sum_at = [&](const Block& versines) {
    Block sum = Block::Zero();
    const auto under = [&](const Resonance::Line& one) -> Block {
      return one.steepness * (versines - one.centre).square() + one.floor;
    };
    for (std::size_t j = 0; j < kTeeth; j += 3) {
      const Block a = under(lines[j]);
      const Block b = under(lines[j + 1]);
      const Block c = under(lines[j + 2]);
      const Block ab = a * b;
      sum +=
          ((lines[j].power * b + lines[j + 1].power * a) * c + lines[j + 2].power * ab) / (ab * c);
    }
    return sum;
  };
  Eigen::ArrayXd out = 2.0 * f.half_sines().square();
  const Eigen::Index whole = out.size() / Block::SizeAtCompileTime * Block::SizeAtCompileTime;
  for (Eigen::Index i = 0; i < whole; i += Block::SizeAtCompileTime)
    out.segment<Block::SizeAtCompileTime>(i) = sum_at(out.segment<Block::SizeAtCompileTime>(i));
  if (const Eigen::Index rest = out.size() - whole; rest > 0) {
    Block last = Block::Ones();
    last.head(rest) = out.tail(rest);
    out.tail(rest) = sum_at(last).head(rest);
  }
  return out;
}

SumCovariance Voigt::sum_covariance() const {
  SumCovariance out;
  for (const Resonance& one : parts()) out += one.sum_covariance();
  return out;
}

std::vector<DerivedQuantity> Voigt::derived(Hertz rate) const {
  double variance = 0.0;
  for (const ExponentialCovariance& one : sum_covariance().exponentials)
    variance += one.amplitude.real();
  // The half-width of a Lorentzian smeared by a Gaussian, to 0.02 % (Olivero & Longbothum 1977).
  const double lorentz = -std::log(r);
  const double gauss = std::sqrt(2.0 * std::numbers::ln2) * spread;
  const double half = 0.5346 * lorentz + std::hypot(std::sqrt(0.2166) * lorentz, gauss);
  return {{Coefficient::kFrequency, omega * rate.value / (2.0 * std::numbers::pi)},
          {Coefficient::kDampingRatio, half / std::hypot(half, omega)},
          {Coefficient::kAmplitude, std::sqrt(variance)}};
}

std::vector<std::vector<double>> Voigt::scan(const Scales& scales) const {
  std::vector<std::vector<double>> out;
  for (const std::vector<double>& one : Resonance{}.scan(scales)) {
    const double lorentz = -std::log(one[0]);
    if (lorentz > 0.2) continue;  // hardly rings
    out.push_back({one[0], one[1], 2.0 * lorentz});
  }
  return out;
}

double Voigt::Recursion::next(RandomStream& rng) {
  double out = 0.0;
  for (SecondOrderRecursion& one : parts_) out += one.next(rng);
  return out;
}

Voigt::Recursion Voigt::recursion(RandomStream& rng) const {
  Recursion out;
  for (const Resonance& one : parts()) out.parts_.push_back(one.recursion(rng));
  return out;
}

}  // namespace imunoise
