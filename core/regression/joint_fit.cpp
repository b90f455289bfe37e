#include "core/regression/joint_fit.h"

#include <algorithm>
#include <cmath>

#include "core/spectrum/cosine_transform.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr int kRounds = 6;
constexpr double kSettled = 1e-4;  // nats

}  // namespace

JointFit joint_fit(const Regression& regression, const Model& start, const Progress& progress,
                   Begin begin, const std::vector<Model>& own_start) {
  JointFit out{.model = {start, regression.effects()}, .effects = regression.under(start)};
  for (int round = 0; round < kRounds && !progress.stopped(); ++round) {
    const std::vector<BandedPower> left = pooled(regression.residual(out.effects, out.model.noise));
    const WhittleEstimate found =
        whittle(out.model.noise, left, progress, round == 0 ? begin : Begin::kNear);
    out.model.noise = found.model;
    out.termination = found.termination;
    out.effects = regression.under(out.model.noise);
    const double before = out.log_likelihood;
    out.log_likelihood =
        -whittle_objective(out.model.noise, pooled(regression.residual(out.effects.value)));
    if (regression.coefficients().empty()) break;
    if (round > 0 && std::abs(out.log_likelihood - before) < kSettled) break;
  }
  for (const EffectTerm& term : regression.effects()) {
    if (term.effect->own_noise == nullptr) continue;
    out.own_noise = own_start;
    term.effect->own_noise(term, regression, out);
  }
  if (const auto& nats = regression.subject().reshaped_nats; !nats.empty()) {
    for (const std::size_t k : regression.replicates()) out.log_likelihood += nats[k];
  }
  const std::vector<VarianceCourse> courses = variance_courses(regression);
  if (courses.empty()) return out;
  // Each explains what those before it leave.
  Innovations white = innovations(regression, out);
  for (const VarianceCourse& course : courses) {
    out.modulation.push_back(modulation_by(course, white));
    out.log_likelihood += out.modulation.back().log_likelihood;
    take_out(out.modulation.back(), course, white);
  }
  return out;
}

std::vector<Model> own_starts(const JointFit& fit, const Model& start) {
  const std::vector<Term>& known = fit.model.noise.terms;
  std::vector<Model> out(fit.own_noise.size(), start);
  std::vector<bool> used(known.size(), false);
  for (std::size_t t = 0; t < start.terms.size(); ++t) {
    for (std::size_t i = 0; i < known.size(); ++i) {
      if (used[i] || known[i].process.index() != start.terms[t].process.index()) continue;
      used[i] = true;
      for (std::size_t k = 0; k < out.size(); ++k) out[k].terms[t] = fit.own_noise[k].terms[i];
      break;
    }
  }
  return out;
}

Innovations innovations(const Regression& regression, const JointFit& fit) {
  Innovations out{regression.replicates(), {}};
  out.white.resize(out.replicates.size());
  for_each_index(out.white.size(), [&](std::size_t i) {
    out.white[i] = innovations(regression, fit, out.replicates[i]);
  });
  return out;
}

Eigen::VectorXd innovations(const Regression& regression, const JointFit& fit, std::size_t k) {
  Eigen::VectorXd left = regression.residual_cosines(fit.effects.value, k);
  const Model& noise = fit.own_noise.empty() ? fit.model.noise : fit.own_noise[k];
  left.array() /= spectrum_of_cosines(noise, left.size() + 1).sqrt();
  Eigen::VectorXd out = rough_inverse_cosine_transform(left);  // white: no digits to lose
  const std::vector<VarianceCourse> courses = variance_courses(regression);
  for (std::size_t m = 0; m < fit.modulation.size(); ++m)
    take_out(fit.modulation[m], courses[m], k, out);
  return out;
}

std::vector<VarianceCourse> variance_courses(const Regression& regression) {
  std::vector<VarianceCourse> out;
  for (const EffectTerm& term : regression.effects()) {
    if (term.effect->variance_course != nullptr)
      out.push_back(term.effect->variance_course(term, regression.subject()));
  }
  return out;
}

}  // namespace imunoise
