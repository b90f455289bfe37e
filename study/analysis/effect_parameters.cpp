#include "study/analysis/effect_parameters.h"

#include <algorithm>
#include <cmath>

#include "core/estimate/whittle.h"
#include "core/inference/efficient_fit.h"
#include "core/inference/intervals.h"
#include "core/inference/parameter_covariance.h"
#include "study/analysis/vocabulary.h"

namespace imunoise::study {
namespace {

constexpr double kConfidence = 0.95;

std::vector<v1::EffectParameter> messages_of(const std::vector<ReportedNumber>& numbers) {
  std::vector<v1::EffectParameter> out;
  for (const ReportedNumber& from : numbers) out.push_back(message_of(from));
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

// A parameter of noise, with the interval that a fit gives it; without one where it is at a bound.
// `evidence`: for its power, in standard errors.
ReportedNumber noise_number(const Term& term, std::size_t parameter, double error, double evidence,
                            Quantity quantity) {
  const ParameterInfo about = parameters(term.process)[parameter];
  ReportedNumber out{about.name, values(term.process)[parameter],
                     unit_of(about.dimension, quantity)};
  if (!(error > 0.0) || !std::isfinite(error)) return out;
  const ParameterEstimate estimate =
      interval(about, parameter, out.value, error, kConfidence, evidence);
  out.lower = estimate.lower;
  out.upper = estimate.upper;
  return out;
}

// The parameters of the noise that was added, and the times and frequencies that they stand for.
void add_noise(const TriedTerm& tried, const Subject& subject, std::vector<ReportedNumber>& out) {
  const Model& fitted = tried.fitted.fit.model.noise;
  const std::size_t kind = std::get<NoiseChange>(tried.suggestion.added).added.index();
  const std::vector<BandedPower> left =
      pooled(tried.fitted.regression.residual(tried.fitted.fit.effects, fitted));
  const std::vector<Eigen::Index> interior = parameter_sets(fitted).interior;
  const ParameterCovariance covariance =
      inverse_information(whittle_information(fitted, left, interior));
  const std::vector<ParameterPlace> places = parameter_places(fitted);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Term& term = fitted.terms[places[i].term];
    if (term.process.index() != kind) continue;
    const auto inside = std::find(interior.begin(), interior.end(), static_cast<Eigen::Index>(i));
    const double error =
        inside == interior.end() ? 0.0 : covariance.standard_error(inside - interior.begin());
    const double evidence = alone(term) ? std::sqrt(2.0 * std::max(0.0, tried.likelihood_gain))
                                        : values(term.process)[0] / error;
    out.push_back(noise_number(term, places[i].parameter, error, evidence, subject.quantity));
    if (places[i].parameter + 1 < term.given.size()) continue;
    for (const DerivedQuantity& quantity : derived(term.process, subject.rate)) {
      if (quantity.coefficient == Coefficient::kCorrelationTime)
        out.push_back({"tau_s", quantity.value, "s"});
      if (quantity.coefficient == Coefficient::kFrequency)
        out.push_back({"frequency_hz", quantity.value, "Hz"});
      if (quantity.coefficient == Coefficient::kCutoff)
        out.push_back({"cutoff_hz", quantity.value, "Hz"});
    }
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

std::vector<ReportedNumber> noise_coefficients(const FittedModel& model, std::size_t term) {
  const Quantity quantity = model.regression.subject().quantity;
  Fit fit;
  fit.estimate.model = model.fit.model.noise;
  fit.confidence = kConfidence;
  fill_likelihood_intervals(
      fit, pooled(model.regression.residual(model.fit.effects, model.fit.model.noise)));
  std::vector<ReportedNumber> out;
  for (const DerivedEstimate& one : fit.derived[term]) {
    const CoefficientUnits units = coefficient_units(one.coefficient, quantity);
    ReportedNumber& number = out.emplace_back();
    number.name = units.title;
    number.value = one.value;
    number.unit = units.si;
    if (std::isfinite(one.lower) && std::isfinite(one.upper) && one.lower < one.upper) {
      number.lower = one.lower;
      number.upper = one.upper;
    }
  }
  return out;
}

v1::EffectParameter message_of(const ReportedNumber& from) {
  v1::EffectParameter to;
  to.set_name(from.name);
  to.set_value(from.value);
  to.set_unit(from.unit);
  if (from.lower) to.set_lower(*from.lower);
  if (from.upper) to.set_upper(*from.upper);
  return to;
}

std::vector<v1::EffectParameter> fitted_parameters(const FittedModel& model, std::size_t number) {
  return messages_of(fitted_numbers({model, number}));
}

}  // namespace imunoise::study
