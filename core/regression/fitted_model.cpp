#include "core/regression/fitted_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/regression/current.h"
#include "core/regression/free_ends.h"
#include "core/regression/uncertain_shape.h"
#include "core/support/distributions.h"

namespace imunoise {
namespace {

// The number of a replicate as it was recorded and, of what follows a cut, when it begins.
std::string place_of(const Subject& subject, std::size_t replicate) {
  const std::size_t number = subject.parts[replicate].recorded + 1;
  if (subject.parts[replicate].first == 0) return std::to_string(number);
  return fmt::format("{} from {:.6g} s on", number, subject.begins(replicate));
}

// A fit to samples that some terms cleaned, given what modulates their power. What modulates it is
// found under the model before them, which takes theirs for its own, and found again beside them.
FittedModel beside_modulation(const std::vector<Modulation>& before,
                              const std::function<FittedModel(std::vector<Modulation>)>& fit) {
  constexpr int kMostTurns = 8;
  constexpr double kSettled = 0.05;  // standard errors
  FittedModel out = fit(before);
  std::vector<Modulation> taken_out = before;
  for (int turn = 1; turn < kMostTurns; ++turn) {
    const std::vector<Modulation>& found = out.fit.modulation;
    bool settled = true;
    for (std::size_t m = 0; m < found.size(); ++m)
      settled =
          settled && std::abs(found[m].slope - taken_out[m].slope) < kSettled * found[m].error;
    if (settled) break;
    taken_out = found;
    out = fit(taken_out);
  }
  return out;
}

}  // namespace

FittedModel fit_full_model(std::shared_ptr<const Subject> subject, const FullModel& start,
                           const Progress& progress) {
  Regression regression(std::move(subject));
  for (const EffectTerm& term : start.effects) {
    if (term.effect->fit_with == nullptr) regression = regression.with(term);
  }
  const FittedModel first =
      beside_free_ends({regression, joint_fit(regression, start.noise, progress)});
  const std::vector<Modulation>& before = first.fit.modulation;
  FittedModel out = beside_modulation(before, [&](std::vector<Modulation> modulation) {
    FittedModel cleaned = first;
    cleaned.fit.modulation = std::move(modulation);
    for (const EffectTerm& term : start.effects) {
      if (term.effect->cleaned == nullptr) continue;
      const Current current = current_of(cleaned.regression, cleaned.fit);
      cleaned.regression = cleaned.regression.on(term.effect->cleaned(term, current));
      cleaned.fit = joint_fit(cleaned.regression, cleaned.fit.model.noise, progress);
    }
    return cleaned;
  });
  for (const EffectTerm& term : start.effects) {
    if (term.effect->fit_with != nullptr)
      out = term.effect->fit_with(term, out.regression, out.fit);
  }
  return out;
}

FittedModel fit_with(const Current& current, const EffectTerm& term) {
  if (term.effect->fit_with != nullptr)
    return term.effect->fit_with(term, current.regression, current.fit);
  const Regression grown = current.regression.with(term);
  const auto fitted = [&](const Regression& regression) {
    return beside_free_ends({regression, joint_fit(regression, current.fit.model.noise, {},
                                                   Begin::kAnywhere, current.fit.own_noise)});
  };
  if (term.effect->cleaned == nullptr) return fitted(grown);
  return beside_modulation(current.fit.modulation, [&](std::vector<Modulation> modulation) {
    JointFit before = current.fit;
    before.modulation = std::move(modulation);
    return fitted(grown.on(term.effect->cleaned(term, current_of(current.regression, before))));
  });
}

FittedModel found_anew(FittedModel model) {
  const Regression& regression = model.regression;
  const auto fits_itself = [](const EffectTerm& term) { return term.effect->fit_with != nullptr; };
  if (regression.first_subject() == regression.shared_subject() ||
      std::any_of(regression.effects().begin(), regression.effects().end(), fits_itself))
    return model;
  FittedModel anew = fit_full_model(regression.first_subject(), model.fit.model);
  return anew.fit.log_likelihood > model.fit.log_likelihood ? anew : model;
}

std::vector<ReportedNumber> coefficient_numbers(const FittedEffect& effect) {
  const Regression& regression = effect.model.regression;
  const EffectCoefficients& found = effect.model.fit.effects;
  const double stretch =
      std::isfinite(effect.noise_dof)
          ? student_quantile(0.975, std::max(1.0, effect.noise_dof)) / interval_reach()
          : 1.0;
  const std::string unit = unit_of(effect.term(), effect.subject());
  const Eigen::ArrayXd growth = growth_by_shape(effect);
  const Eigen::Index first = regression.first(effect.number);
  std::vector<ReportedNumber> out;
  for (Eigen::Index i = first; i < regression.first(effect.number + 1); ++i) {
    const CoefficientName& name = regression.coefficients()[static_cast<std::size_t>(i)];
    const std::string label = name.replicate == CoefficientName::kAll
                                  ? name.name
                                  : fmt::format("{} in replicate {}", name.name,
                                                place_of(regression.subject(), name.replicate));
    const double error = stretch * growth(i - first) * std::sqrt(found.covariance(i, i));
    out.push_back(with_error({label, found.value(i), unit}, error));
  }
  return out;
}

std::vector<ReportedNumber> fitted_numbers(const FittedEffect& effect) {
  const Effect& about = *effect.term().effect;
  return about.numbers == nullptr ? coefficient_numbers(effect) : about.numbers(effect);
}

std::string unit_of(const EffectTerm& term, const Subject& subject) {
  if (term.effect->unit != nullptr) return term.effect->unit(term, subject);
  return std::string(si_symbol(subject.quantity));
}

EffectTerm with_truth(const EffectTerm& term, const std::vector<ReportedNumber>& found) {
  EffectTerm out = term;
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    const EffectParameter& about = out.effect->parameters[i];
    if (!about.truth) continue;
    double squares = 0.0;
    double count = 0.0;
    for (const ReportedNumber& one : found) {
      // Of several alike, such as the multiples of a wave, the first is meant.
      const bool whole =
          one.name == about.reported || one.name == fmt::format("{}_1", about.reported);
      if (whole) out.values[i] = one.value;
      if (whole || !one.name.starts_with(fmt::format("{} in ", about.reported))) continue;
      squares += one.value * one.value;
      ++count;
    }
    if (count > 0.0) out.values[i] = std::sqrt(squares / count);
  }
  return out;
}

}  // namespace imunoise
