#include "core/diagnosis/candidates.h"

#include <algorithm>
#include <cmath>

#include "core/diagnosis/causes.h"
#include "core/diagnosis/missing_noise.h"
#include "core/inference/parameter_covariance.h"
#include "core/regression/free_ends.h"
#include "core/support/linear_algebra.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr double kBeyondWander = 12.0;  // nats: less may be what wanders

// Degrees of freedom of the noise level where an effect's coefficients get their information: 2
// over the variance of its logarithm, by the information on the noise's parameters (Satterthwaite
// 1946).
double noise_dof_of(const FittedModel& fitted, std::size_t effect) {
  const Regression& regression = fitted.regression;
  const Index first = regression.first(effect);
  const Index last = regression.first(effect + 1);
  if (first == last) return INFINITY;
  EffectCoefficients own = fitted.fit.effects;
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(own.covariance.rows(), own.covariance.cols());
  block.block(first, first, last - first, last - first) =
      own.covariance.block(first, first, last - first, last - first);
  own.covariance = block;
  const Model& noise = fitted.fit.model.noise;
  const std::vector<Eigen::ArrayXd> share = regression.leverage(own, noise);
  const std::vector<BandedPower> bands = regression.residual(fitted.fit.effects.value);
  const std::vector<Index> interior = parameter_sets(noise).interior;
  const auto p = static_cast<Index>(interior.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(p, p);
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(p);
  double total = 0.0;
  for (std::size_t k = 0; k < bands.size(); ++k) {
    const Eigen::MatrixXd slopes = whittle_slopes(noise, bands[k], interior);
    information += slopes.transpose() * slopes;
    const Eigen::VectorXd weight = (share[k] / (0.5 * bands[k].count).sqrt()).matrix();
    slope += slopes.transpose() * weight;
    total += share[k].sum();
  }
  if (!(total > 0.0)) return INFINITY;
  slope /= total;
  const double variance = slope.dot(pseudo_inverse(information).matrix * slope);
  return variance > 0.0 ? std::max(1.0, 2.0 / variance) : INFINITY;
}

TriedTerm tried_term(const Current& current, const Suggestion& suggestion) {
  FittedModel fitted = fit_with(current, suggestion);
  TriedTerm out{.cause = std::string(suggestion.cause),
                .suggestion = suggestion,
                .fitted = std::move(fitted)};
  out.likelihood_gain = out.fitted.fit.log_likelihood - current.fit.log_likelihood;
  const std::size_t effects = out.fitted.regression.effects().size();
  const EffectTerm* const term = out.term();
  out.noise_dof = term == nullptr ? INFINITY : noise_dof_of(out.fitted, effects - 1);
  out.noise_dof = std::min(out.noise_dof, suggestion.noise_dof);
  out.slow = cause_info(out.cause).slow;
  if (term == nullptr) {
    review_noise(current, out);
  } else if (term->effect->review != nullptr) {
    term->effect->review(current, out);
  }
  const Suggestion& how = out.suggestion;
  out.log_p = log_p_value(out.likelihood_gain / how.inflation, how.dof, out.noise_dof, how.power,
                          how.search);
  out.gain = -out.log_p;
  if (out.against_wander && out.gain > kBeyondWander) {
    out.gain = out.next_gain -
               log_p_value(out.likelihood_gain, how.dof, out.noise_dof, how.power, how.search);
  }
  return out;
}

}  // namespace

void best_first(std::vector<TriedTerm>& tried) {
  std::stable_sort(tried.begin(), tried.end(),
                   [](const TriedTerm& a, const TriedTerm& b) { return a.gain > b.gain; });
}

FittedModel fit_with(const Current& current, const Suggestion& suggestion) {
  if (const auto* term = std::get_if<EffectTerm>(&suggestion.added))
    return fit_with(current, *term);
  const auto& change = std::get<NoiseChange>(suggestion.added);
  Regression regression = current.regression;
  if (change.shared) regression = regression.with(*change.shared);
  JointFit fit = joint_fit(regression, change.start, {}, Begin::kAnywhere,
                           own_starts(current.fit, change.start));
  return beside_free_ends({std::move(regression), std::move(fit)});
}

double promised(const Suggestion& one) {
  return -log_p_value(one.score_nats, one.dof, one.noise_dof, one.power, one.search);
}

std::vector<TriedTerm> try_all(const Current& current, const Suggestions& suggestions,
                               const Progress& progress) {
  // Terms that noise alone suggests are not worth a fit.
  constexpr double kWorthTrying = 2.0;  // nats
  constexpr double kLittle = 5.0;       // nats
  std::vector<const Suggestion*> worth;
  double most = 0.0;
  for (const Suggestion& one : suggestions) {
    if (!(one.score_nats > kWorthTrying)) continue;
    worth.push_back(&one);
    most = std::max(most, promised(one));
  }
  std::vector<std::optional<TriedTerm>> tried(worth.size());
  const auto try_one = [&](std::size_t i) {
    Suggestion one = *worth[i];
    if (auto* term = std::get_if<EffectTerm>(&one.added))
      *term = rounded(*term, one.shape_error, current.subject().rate);
    tried[i] = tried_term(current, one);
  };
  // Not what others mask.
  const auto try_from = [&](double least) {
    for_each_index(worth.size(), [&](std::size_t i) {
      if (!tried[i] && promised(*worth[i]) >= least && !progress.stopped()) try_one(i);
    });
  };
  const auto best = [&] {
    double out = 0.0;
    for (const auto& one : tried) out = one ? std::max(out, one->gain) : out;
    return out;
  };
  try_from(kMasked * most);
  const double masked = kMasked * best();
  try_from(masked > kLittle ? masked : -INFINITY);
  std::vector<TriedTerm> out;
  for (auto& one : tried) {
    if (one) out.push_back(std::move(*one));
  }
  best_first(out);
  return out;
}

}  // namespace imunoise
