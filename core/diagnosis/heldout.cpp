#include "core/diagnosis/heldout.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/inference/normal_scores.h"
#include "core/spectrum/cosine_transform.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr std::size_t kBlocks = 4;    // of a single replicate, which stand in for replicates
constexpr Index kShortestCut = 4096;  // samples

Scales scales_of(const Eigen::VectorXd& samples) {
  return Scales::for_samples(static_cast<std::size_t>(samples.size()));
}

WaveletVariance variance_of(const Eigen::VectorXd& samples, const Subject& subject,
                            const Scales& scales) {
  const std::span<const double> all(samples.data(), static_cast<std::size_t>(samples.size()));
  return wavelet_variance(Signal(all, subject.rate, subject.quantity), scales);
}

// One number a replicate.
std::vector<double> wavelet_errors(const std::vector<WaveletVariance>& left, const Model& noise) {
  const auto scores = normal_scores(noise, left, moment_covariances(noise, left));
  std::vector<double> out;
  for (std::size_t k = 0; k < left.size(); ++k) {
    const Eigen::VectorXd z =
        scores[k].residual(left[k].variance, variance(noise, left[k].scales.half_widths()));
    out.push_back(z.size() > 0 ? z.squaredNorm() / static_cast<double>(z.size()) : 1.0);
  }
  return out;
}

double log_likelihood_of(const Regression& one, const Eigen::VectorXd& coefficients,
                         const Model& noise) {
  return -whittle_objective(noise, one.residual(coefficients));
}

// What the modulated effects of a fit to others gain on one replicate, whose coefficients are
// given.
double modulation_gain(const Regression& one, const JointFit& fit,
                       const Eigen::VectorXd& coefficients) {
  if (fit.modulation.empty()) return 0.0;
  double out = 0.0;
  Innovations white = innovations(one, {.model = fit.model, .effects = {coefficients, {}}});
  const std::vector<const VarianceCourse*> courses = variance_courses(one);
  for (std::size_t m = 0; m < courses.size(); ++m) {
    out += predicted_gain(fit.modulation[m], *courses[m], white);
    take_out(fit.modulation[m], *courses[m], white);
  }
  return out;
}

}  // namespace

bool can_hold_out(const FittedModel& fitted) {
  const auto& effects = fitted.regression.effects();
  const Subject& subject = fitted.regression.subject();
  return (subject.replicates() > 1 || subject.length(0) >= kShortestCut) &&
         std::none_of(effects.begin(), effects.end(),
                      [](const EffectTerm& term) { return term.effect->own_noise != nullptr; });
}

double Errors::mean_error() const {
  return std::accumulate(error.begin(), error.end(), 0.0) / static_cast<double>(error.size());
}

double Errors::error_of_mean() const {
  if (error.size() < 2) return 0.0;
  const double mean = mean_error();
  double squares = 0.0;
  for (const double one : error) squares += (one - mean) * (one - mean);
  const auto n = static_cast<double>(error.size());
  return std::sqrt(squares / (n * (n - 1.0)));
}

double Errors::total_likelihood() const {
  return std::accumulate(log_likelihood.begin(), log_likelihood.end(), 0.0);
}

LeftOver left_over(const FittedModel& fitted) {
  const Subject& subject = fitted.regression.subject();
  LeftOver out{std::vector<WaveletVariance>(subject.replicates()), {}};
  std::vector<WaveletVariance> all(subject.replicates());
  const Scales run_off = run_off_scales(subject);
  for_each_index(subject.replicates(), [&](std::size_t k) {
    const Eigen::VectorXd left = fitted.regression.residual_samples(fitted.fit.effects.value, k);
    const Scales octaves = scales_of(left);
    all[k] = variance_of(left, subject, octaves.with(run_off));
    out.variances[k] = at_scales(all[k], octaves);
  });
  out.run_off = run_off_of(fitted, all);
  return out;
}

Errors training_errors(const FittedModel& fitted, const LeftOver& left) {
  const std::size_t count = fitted.regression.subject().replicates();
  const std::vector<Model>& own = fitted.fit.own_noise;
  Errors out{std::vector<double>(count), std::vector<double>(count)};
  if (own.empty()) out.error = wavelet_errors(left.variances, fitted.fit.model.noise);
  for_each_index(count, [&](std::size_t k) {
    const Model& noise = own.empty() ? fitted.fit.model.noise : own[k];
    if (!own.empty()) out.error[k] = wavelet_errors({left.variances[k]}, noise).front();
    out.log_likelihood[k] =
        log_likelihood_of(fitted.regression.of({k}), fitted.fit.effects.value, noise);
  });
  return out;
}

Errors heldout_errors(const FittedModel& fitted) {
  const bool single = fitted.regression.subject().replicates() == 1;
  const Regression all = single ? fitted.regression.in_blocks(kBlocks) : fitted.regression;
  const auto left_in = [&](const Eigen::VectorXd& coefficients, std::size_t k) -> Eigen::VectorXd {
    if (single) return inverse_cosine_transform(all.residual_cosines(coefficients, k));
    return all.residual_samples(coefficients, k);
  };
  const std::size_t count = all.subject().replicates();
  Errors out{std::vector<double>(count), std::vector<double>(count)};
  for_each_index(count, [&](std::size_t k) {
    std::vector<std::size_t> others;
    for (std::size_t i = 0; i < count; ++i) {
      if (i != k) others.push_back(i);
    }
    const JointFit fit = joint_fit(all.of(others), fitted.fit.model.noise);
    const Model& noise = fit.model.noise;
    const Regression one = all.of({k});
    const Eigen::VectorXd at = one.under(noise, fit.effects.value).value;
    // What the replicate itself gave: a coefficient costs a nat.
    const auto& own_nats = all.subject().own_nats;
    double own = own_nats.empty() ? 0.0 : own_nats[k];
    for (const CoefficientName& name : all.coefficients()) own += name.replicate == k ? 1.0 : 0.0;
    const Eigen::VectorXd left = left_in(at, k);
    out.error[k] =
        wavelet_errors({variance_of(left, all.subject(), scales_of(left))}, noise).front();
    out.log_likelihood[k] = log_likelihood_of(one, at, noise) - own + modulation_gain(one, fit, at);
  });
  return out;
}

}  // namespace imunoise
