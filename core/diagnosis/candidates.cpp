#include "core/diagnosis/candidates.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/diagnosis/outliers.h"
#include "core/diagnosis/steadiness.h"
#include "core/diagnosis/telegraph.h"
#include "core/diagnosis/two_levels.h"
#include "core/inference/parameter_covariance.h"
#include "core/support/linear_algebra.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

// Degrees of freedom of the noise level where an effect's coefficients get their information: 2
// over the variance of its logarithm, by the information on the noise's parameters (Satterthwaite
// 1946).
double freedom_of(const Trial& trial, std::size_t effect) {
  const Regression& regression = trial.regression;
  const Index first = regression.first(effect);
  const Index last = regression.first(effect + 1);
  if (first == last) return INFINITY;
  EffectCoefficients own = trial.fit.effects;
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(own.covariance.rows(), own.covariance.cols());
  block.block(first, first, last - first, last - first) =
      own.covariance.block(first, first, last - first, last - first);
  own.covariance = block;
  const Model& noise = trial.fit.model.noise;
  const std::vector<Eigen::ArrayXd> share = regression.leverage(own, noise);
  const std::vector<BandedPower> bands = regression.residual(trial.fit.effects.value);
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

// A Markov process so fast that it left no white noise is the sensor's bandwidth.
bool is_bandwidth(const Model& noise) {
  constexpr double kFastest = 20.0;  // samples
  constexpr double kLeft = 0.1;
  double white = 0.0;
  double fast = 0.0;
  for (const Term& term : noise.terms) {
    const auto* markov = std::get_if<Ar1>(&term.process);
    if (std::holds_alternative<WhiteNoise>(term.process)) white += spectrum(term.process, 0.5);
    if (markov != nullptr && markov->phi > 0.0 && -1.0 / std::log(markov->phi) < kFastest)
      fast += spectrum(term.process, 0.5);
  }
  return fast > 0.0 && white < kLeft * fast;
}

// Heat does not move a sensor faster than this.
constexpr double kFastestHeat = 10.0;  // s

// Of the noise that each replicate has of its own: the share that white noise alone explains.
bool slow_powers(const Trial& trial, const JointFit& before) {
  const Regression& regression = trial.regression;
  Model held = before.model.noise;
  for (Term& term : held.terms)
    term.given.assign(term.given.size(), !std::holds_alternative<WhiteNoise>(term.process));
  double fast = 0.0;
  for (const BandedPower& one : regression.residual(trial.fit.effects.value)) {
    const std::span<const BandedPower> alone(&one, 1);
    fast += whittle_objective(before.model.noise, alone) - whittle(held, alone).objective;
  }
  return fast < 0.5 * (trial.fit.log_likelihood - before.log_likelihood);
}

bool is_slow(const TriedEffect& tried, const Current& current) {
  const std::string& id = tried.effect;
  if (id == "rate_ramp" || id == "warm_up" || id == "random_walk" || id == "flicker") return true;
  if (id == "replicate_change") return slow_powers(tried.trial, current.fit);
  if (id != "gauss_markov") return false;
  const double longest = kFastestHeat * current.subject().rate.value;
  const auto& terms = tried.trial.fit.model.noise.terms;
  return std::any_of(terms.begin(), terms.end(), [&](const Term& term) {
    const auto* markov = std::get_if<Ar1>(&term.process);
    return markov != nullptr && markov->phi > 0.0 && -1.0 / std::log(markov->phi) > longest;
  });
}

bool is_course(const Suggestion& suggestion) {
  const auto* term = std::get_if<EffectTerm>(&suggestion.added);
  return term != nullptr && term->kind == EffectKind::kTelegraph;
}

// A level that is left and never taken again was no level of two.
bool jumps_once(const Trial& trial) {
  const std::vector<TwoLevelCourse>& courses = trial.regression.subject().courses;
  return std::all_of(courses.begin(), courses.end(),
                     [](const TwoLevelCourse& one) { return one.jumps.size() <= 1; });
}

// Does what it says of time hold?
bool is_steady(const TriedEffect& tried) {
  constexpr double kUnsteady = 1e-3;
  if (const auto* noise = std::get_if<NoiseChange>(&tried.suggestion.added)) {
    if (tried.effect == "telegraph") return true;
    return steadiness(tried.trial.regression, tried.trial.fit, noise->added).p_value > kUnsteady;
  }
  if (!is_course(tried.suggestion)) return true;
  // Dwells too short to be seen move the levels between the others a little.
  constexpr double kLittle = 0.05;
  constexpr double kMoreThanTwo = 0.01;
  const TestOutcome more = more_levels(tried.trial);
  return more.p_value > kMoreThanTwo || 0.5 * more.statistic < kLittle * tried.likelihood_gain;
}

void name_better(TriedEffect& tried) {
  if (is_course(tried.suggestion) && jumps_once(tried.trial)) tried.effect = "step";
  if (tried.effect != "gauss_markov") return;
  if (is_bandwidth(tried.trial.fit.model.noise)) {
    tried.effect = "low_pass";
    return;
  }
  const double levels = two_level_gain(tried.trial.regression, tried.trial.fit);
  constexpr double kClearly = 5.0;
  if (levels < kClearly) return;
  tried.effect = "telegraph";
  tried.likelihood_gain += levels - kClearly;  // so much chance may gain
}

}  // namespace

void best_first(std::vector<TriedEffect>& effects) {
  std::stable_sort(effects.begin(), effects.end(),
                   [](const TriedEffect& a, const TriedEffect& b) { return a.gain > b.gain; });
}

Trial try_out(const Current& current, const Suggestion& suggestion) {
  if (const auto* change = std::get_if<NoiseChange>(&suggestion.added))
    return {current.regression, joint_fit(current.regression, change->start)};
  const auto& term = std::get<EffectTerm>(suggestion.added);
  if (term.kind == EffectKind::kTelegraph) return with_two_levels(current.regression, current.fit);
  Regression grown = current.regression.with(term);
  if (term.kind == EffectKind::kOutliers)
    grown = grown.on(without(current.subject(), find_outliers(current, term.above)));
  JointFit fit = joint_fit(grown, current.fit.model.noise);
  return {std::move(grown), std::move(fit)};
}

std::vector<TriedEffect> try_all(const Current& current, const Suggestions& suggestions,
                                 const Progress& progress) {
  // Effects that noise alone suggests are not worth a fit.
  constexpr double kWorthTrying = 2.0;  // nats
  std::vector<const Suggestion*> worth;
  for (const Suggestion& one : suggestions) {
    if (one.score_nats > kWorthTrying) worth.push_back(&one);
  }
  std::vector<std::optional<TriedEffect>> tried(worth.size());
  for_each_index(worth.size(), [&](std::size_t i) {
    if (progress.stopped()) return;
    Suggestion one = *worth[i];
    if (auto* term = std::get_if<EffectTerm>(&one.added))
      *term = rounded(*term, one.shape_error, current.subject().rate);
    Trial trial = try_out(current, one);
    if (is_course(one)) one.search.log_places = log_places(trial.regression.subject().courses);
    TriedEffect out{
        .effect = std::string(one.effect), .suggestion = one, .trial = std::move(trial)};
    out.likelihood_gain = out.trial.fit.log_likelihood - current.fit.log_likelihood;
    const std::size_t effects = out.trial.regression.effects().size();
    out.freedom = std::holds_alternative<EffectTerm>(one.added) ? freedom_of(out.trial, effects - 1)
                                                                : INFINITY;
    name_better(out);
    out.slow = is_slow(out, current);
    out.steady = is_steady(out);
    out.log_chance = log_chance(out.likelihood_gain, one.dof, out.freedom, one.power, one.search);
    out.gain = -out.log_chance;
    tried[i] = std::move(out);
  });
  std::vector<TriedEffect> out;
  for (auto& one : tried) {
    if (one) out.push_back(std::move(*one));
  }
  best_first(out);
  return out;
}

}  // namespace imunoise
