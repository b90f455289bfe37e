#include "core/diagnosis/joint_fit.h"

#include <algorithm>
#include <cmath>

#include "core/spectrum/bands.h"
#include "core/spectrum/cosine_transform.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr int kRounds = 6;
constexpr double kSettled = 1e-4;  // nats

bool has(const Regression& regression, EffectKind kind) {
  return std::any_of(regression.effects().begin(), regression.effects().end(),
                     [&](const EffectTerm& term) { return term.kind == kind; });
}

// The model with all that is not a power held as it is.
Model powers_only(Model model) {
  for (Term& term : model.terms) {
    for (std::size_t p = 1; p < term.given.size(); ++p) term.given[p] = true;
  }
  return model;
}

void fit_own_powers(JointFit& fit, const Regression& regression) {
  const std::vector<BandedPower> left = regression.residual(fit.effects.value);
  fit.log_likelihood = 0.0;
  for (const BandedPower& one : left) {
    const WhittleEstimate found = whittle(powers_only(fit.model.noise), std::span(&one, 1));
    fit.log_likelihood -= found.objective;
    fit.own_powers.push_back(found.model);
  }
}

}  // namespace

JointFit joint_fit(const Regression& regression, const Model& start, const Progress& progress) {
  JointFit out{{start, regression.effects()}, {}, {}, {}, 0.0, Termination::kConverged};
  out.effects = regression.under(start);
  for (int round = 0; round < kRounds && !progress.stopped(); ++round) {
    const std::vector<BandedPower> left = pooled(regression.residual(out.effects, out.model.noise));
    const WhittleEstimate found = whittle(out.model.noise, left, progress);
    out.model.noise = found.model;
    out.termination = found.termination;
    out.effects = regression.under(out.model.noise);
    const double before = out.log_likelihood;
    out.log_likelihood =
        -whittle_objective(out.model.noise, pooled(regression.residual(out.effects.value)));
    if (regression.coefficients().empty()) break;
    if (round > 0 && std::abs(out.log_likelihood - before) < kSettled) break;
  }
  if (has(regression, EffectKind::kOwnPowers)) fit_own_powers(out, regression);
  if (has(regression, EffectKind::kModulated)) {
    std::vector<Eigen::VectorXd> white;
    for (std::size_t k = 0; k < regression.subject().replicates(); ++k)
      white.push_back(innovations(regression, out, k));
    for (const EffectTerm& term : regression.effects()) {
      if (term.kind != EffectKind::kModulated) continue;
      out.modulation.push_back(modulation_by(*regression.subject().find(term.witness), white));
      out.log_likelihood += out.modulation.back().log_likelihood;
    }
  }
  return out;
}

Eigen::VectorXd innovations(const Regression& regression, const JointFit& fit,
                            std::size_t replicate) {
  const Eigen::VectorXd left = regression.residual_cosines(fit.effects.value, replicate);
  const Model& noise = fit.own_powers.empty() ? fit.model.noise : fit.own_powers[replicate];
  const Eigen::ArrayXd spectrum = spectrum_of_cosines(noise, left.size() + 1);
  return inverse_cosine_transform((left.array() / spectrum.sqrt()).matrix());
}

Modulation modulation_by(const Witness& witness, const std::vector<Eigen::VectorXd>& innovations) {
  // Sums over short stretches, in which the witness hardly moves, stand for the samples.
  constexpr Index kStretch = 32;
  Index stretches = 0;
  for (const Eigen::VectorXd& y : innovations) stretches += y.size() / kStretch;
  if (stretches == 0) return {};
  Eigen::ArrayXd power(stretches);
  Eigen::ArrayXd covariate(stretches);
  Index place = 0;
  for (std::size_t k = 0; k < innovations.size(); ++k) {
    for (Index i = 0; i + kStretch <= innovations[k].size(); i += kStretch, ++place) {
      power(place) = innovations[k].segment(i, kStretch).squaredNorm();
      covariate(place) = witness.samples[k].segment(i, kStretch).mean();
    }
  }
  covariate -= covariate.mean();
  const double deviation = std::sqrt(covariate.square().mean());
  if (!(deviation > 0.0)) return {};
  covariate /= deviation;
  power *= static_cast<double>(kStretch) / power.mean();  // the mean level is the noise model's
  const auto count = static_cast<double>(kStretch);
  const auto gain = [&](double b) {
    // The level that goes with b, at its best.
    const double level = ((-b * covariate).exp() * power).mean() / count;
    return -0.5 * count * static_cast<double>(stretches) * std::log(level);
  };
  double b = 0.0;
  for (int step = 0; step < 20; ++step) {
    const Eigen::ArrayXd share = (-b * covariate).exp() * power;
    const double mean = (share * covariate).sum() / share.sum();
    const double spread = (share * covariate.square()).sum() / share.sum() - mean * mean;
    const double move = std::clamp(mean / spread, -1.0, 1.0);
    b += move;
    if (std::abs(move) < 1e-9) break;
  }
  return {b, std::sqrt(2.0 / (count * static_cast<double>(stretches))), gain(b)};
}

Eigen::ArrayXd spectrum_of_cosines(const Model& noise, Index n) {
  const Bands bands(n);
  Eigen::ArrayXd level = Eigen::ArrayXd::Zero(bands.size());
  for (const Term& term : noise.terms) level += spectrum(term.process, bands.frequency);
  Eigen::ArrayXd out(n - 1);
  for (Index b = 0; b < bands.size(); ++b) {
    const Index begin = bands.edges[static_cast<std::size_t>(b)];
    out.segment(begin, bands.edges[static_cast<std::size_t>(b) + 1] - begin).setConstant(level(b));
  }
  return out;
}

}  // namespace imunoise
