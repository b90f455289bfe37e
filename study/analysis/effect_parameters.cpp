#include "study/analysis/effect_parameters.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/estimate/whittle.h"
#include "core/inference/parameter_covariance.h"
#include "core/support/linear_algebra.h"
#include "study/analysis/vocabulary.h"

namespace imunoise::study {
namespace {

std::vector<v1::EffectParameter> messages_of(const std::vector<ReportedNumber>& numbers) {
  std::vector<v1::EffectParameter> out;
  for (const ReportedNumber& from : numbers) {
    v1::EffectParameter& to = out.emplace_back();
    to.set_name(from.name);
    to.set_value(from.value);
    to.set_unit(from.unit);
    if (from.lower) to.set_lower(*from.lower);
    if (from.upper) to.set_upper(*from.upper);
  }
  return out;
}

// The parameters that give an effect its shape, as the search found them.
void add_shape(const EffectTerm& term, double shape_error, std::vector<ReportedNumber>& out) {
  for (std::size_t i = 0; i < term.values.size(); ++i) {
    const EffectParameter& about = term.effect->parameters[i];
    if (about.truth || about.reported.empty() || !term.given(i)) continue;
    ReportedNumber one{std::string(about.reported), term[i], std::string(about.unit)};
    if (about.error == ShapeError::kAbsolute) one = with_error(std::move(one), shape_error);
    if (about.error == ShapeError::kLogarithm) one = with_log_error(std::move(one), shape_error);
    out.push_back(std::move(one));
  }
}

void add_noise(const TriedTerm& tried, const Subject& subject, std::vector<ReportedNumber>& out) {
  const Model& fitted = tried.fitted.fit.model.noise;
  const std::size_t kind = std::get<NoiseChange>(tried.suggestion.added).added.index();
  const std::vector<BandedPower> left =
      pooled(tried.fitted.regression.residual(tried.fitted.fit.effects, fitted));
  const ParameterSets sets = parameter_sets(fitted);
  const PseudoInverse covariance = pseudo_inverse(whittle_information(fitted, left, sets.interior));
  Eigen::Index column = 0;
  for (const Term& term : fitted.terms) {
    const std::vector<ParameterInfo> about = parameters(term.process);
    const std::vector<double> v = values(term.process);
    for (std::size_t p = 0; p < v.size(); ++p, ++column) {
      if (term.process.index() != kind) continue;
      const auto place = std::find(sets.interior.begin(), sets.interior.end(), column);
      const double error = place == sets.interior.end()
                               ? 0.0
                               : std::sqrt(covariance.matrix(place - sets.interior.begin(),
                                                             place - sets.interior.begin()));
      const std::string unit = unit_of(about[p].dimension, subject.quantity);
      const double relative = error / v[p];
      out.push_back(p == 0 ? with_log_error({about[p].name, v[p], unit}, relative)
                           : with_error({about[p].name, v[p], unit}, error));
    }
    if (term.process.index() != kind) continue;
    if (const auto* markov = std::get_if<Ar1>(&term.process); markov != nullptr && markov->phi > 0)
      out.push_back({"tau_s", -1.0 / (subject.rate.value * std::log(markov->phi)), "s"});
    if (const auto* ringing = std::get_if<Resonance>(&term.process))
      out.push_back(
          {"frequency_hz", 0.5 * ringing->omega / std::numbers::pi * subject.rate.value, "Hz"});
  }
}

}  // namespace

std::vector<v1::EffectParameter> effect_parameters(const TriedTerm& tried, const Subject& subject) {
  std::vector<ReportedNumber> first;
  const EffectTerm* const term = tried.term();
  if (term == nullptr) {
    add_noise(tried, subject, first);
    return messages_of(first);
  }
  std::vector<ReportedNumber> last;
  add_shape(*term, tried.suggestion.shape_error, first);
  if (term->effect->more_numbers != nullptr) term->effect->more_numbers(tried, first, last);
  const std::size_t number = tried.fitted.regression.effects().size() - 1;
  for (auto& one : fitted_numbers({tried.fitted, number, tried.noise_dof}))
    first.push_back(std::move(one));
  first.insert(first.end(), last.begin(), last.end());
  return messages_of(first);
}

std::vector<v1::EffectParameter> fitted_parameters(const FittedModel& model, std::size_t number) {
  return messages_of(fitted_numbers({model, number}));
}

}  // namespace imunoise::study
