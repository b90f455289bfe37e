#include "study/analysis/effect_parameters.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/estimate/whittle.h"
#include "core/inference/parameter_covariance.h"
#include "core/support/distributions.h"
#include "core/support/linear_algebra.h"

namespace imunoise::study {
namespace {

constexpr double kConfidence = 0.95;

double reach() { return normal_quantile(0.5 + 0.5 * kConfidence); }

v1::EffectParameter parameter(std::string name, double value, std::string unit) {
  v1::EffectParameter out;
  out.set_name(std::move(name));
  out.set_value(value);
  out.set_unit(std::move(unit));
  return out;
}

v1::EffectParameter with_error(v1::EffectParameter to, double error) {
  if (!(error > 0.0) || !std::isfinite(error)) return to;
  to.set_lower(to.value() - reach() * error);
  to.set_upper(to.value() + reach() * error);
  return to;
}

v1::EffectParameter with_log_error(v1::EffectParameter to, double error) {
  if (!(error > 0.0) || !std::isfinite(error)) return to;
  to.set_lower(to.value() * std::exp(-reach() * error));
  to.set_upper(to.value() * std::exp(reach() * error));
  return to;
}

std::string unit_name(Quantity quantity) {
  const std::string_view symbol = si_symbol(quantity);
  return symbol.empty() ? "1" : std::string(symbol);
}

// The coefficients of the last effect of a trial: those that all replicates share, with their
// errors.
void add_shared(const TriedEffect& effect, const std::string& unit,
                std::vector<v1::EffectParameter>& out) {
  const Regression& regression = effect.trial.regression;
  const std::size_t last = regression.effects().size() - 1;
  const EffectCoefficients& found = effect.trial.fit.effects;
  // The noise level is itself an estimate: Student's law.
  const double stretch =
      std::isfinite(effect.freedom)
          ? student_quantile(0.5 + 0.5 * kConfidence, std::max(1.0, effect.freedom)) / reach()
          : 1.0;
  for (Eigen::Index i = regression.first(last); i < regression.first(last + 1); ++i) {
    const CoefficientName& name = regression.coefficients()[static_cast<std::size_t>(i)];
    const std::string label =
        name.replicate == CoefficientName::kAll
            ? name.name
            : fmt::format("{} in replicate {}", name.name, name.replicate + 1);
    out.push_back(with_error(parameter(label, found.value(i), unit),
                             stretch * std::sqrt(found.covariance(i, i))));
  }
}

// Amplitude of each multiple of a wave, over all replicates: root mean square less what noise adds.
void add_amplitudes(const TriedEffect& effect, const std::string& unit, int harmonics,
                    std::vector<v1::EffectParameter>& out) {
  const Regression& regression = effect.trial.regression;
  const Eigen::Index first = regression.first(regression.effects().size() - 1);
  const EffectCoefficients& found = effect.trial.fit.effects;
  const auto replicates = static_cast<double>(regression.subject().replicates());
  for (int h = 0; h < harmonics; ++h) {
    double square = 0.0;
    double noise = 0.0;
    for (std::size_t k = 0; k < regression.subject().replicates(); ++k) {
      const Eigen::Index at = first + 2 * (static_cast<Eigen::Index>(k) * harmonics + h);
      square += found.value.segment(at, 2).squaredNorm();
      noise += found.covariance(at, at) + found.covariance(at + 1, at + 1);
    }
    const double amplitude = std::sqrt(std::max(0.0, square - noise) / replicates);
    const double error = std::sqrt(0.5 * noise) / replicates;
    out.push_back(
        with_error(parameter(harmonics == 1 ? "amplitude" : fmt::format("amplitude_{}", h + 1),
                             amplitude, unit),
                   error));
  }
}

void add_noise(const TriedEffect& effect, const Subject& subject,
               std::vector<v1::EffectParameter>& out) {
  const Model& fitted = effect.trial.fit.model.noise;
  const std::size_t kind = std::get<NoiseChange>(effect.suggestion.added).added.index();
  const std::vector<BandedPower> left =
      pooled(effect.trial.regression.residual(effect.trial.fit.effects, fitted));
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
      const std::string unit =
          about[p].dimension == Dimension::kPower ? unit_name(subject.quantity) + "²" : "1";
      const double relative = error / v[p];
      out.push_back(p == 0 ? with_log_error(parameter(about[p].name, v[p], unit), relative)
                           : with_error(parameter(about[p].name, v[p], unit), error));
    }
    if (term.process.index() != kind) continue;
    if (const auto* markov = std::get_if<Ar1>(&term.process); markov != nullptr && markov->phi > 0)
      out.push_back(parameter("tau_s", -1.0 / (subject.rate.value * std::log(markov->phi)), "s"));
    if (const auto* ringing = std::get_if<Resonance>(&term.process))
      out.push_back(parameter("frequency_hz",
                              0.5 * ringing->omega / std::numbers::pi * subject.rate.value, "Hz"));
  }
}

}  // namespace

std::string coupling_unit(Quantity subject, const Witness& witness, const EffectTerm& term) {
  std::string below = unit_name(witness.quantity) + (term.quadratic ? "²" : "");
  if (term.derivative) below = fmt::format("({}/s)", below);
  if (below == unit_name(subject)) return "1";
  return below == "1" ? unit_name(subject) : fmt::format("{}/{}", unit_name(subject), below);
}

std::vector<v1::EffectParameter> effect_parameters(const TriedEffect& effect,
                                                   const Subject& subject) {
  std::vector<v1::EffectParameter> out;
  const auto* term = std::get_if<EffectTerm>(&effect.suggestion.added);
  if (term == nullptr) {
    add_noise(effect, subject, out);
    return out;
  }
  const std::string unit = unit_name(subject.quantity);
  const double shape = effect.suggestion.shape_error;
  switch (term->kind) {
    case EffectKind::kRamp:
      add_shared(effect, unit + "/s", out);
      break;
    case EffectKind::kWarmUp:
      out.push_back(with_log_error(parameter("tau_s", term->tau, "s"), shape));
      add_shared(effect, unit, out);
      break;
    case EffectKind::kLine:
      out.push_back(with_error(parameter("frequency_hz", term->frequency, "Hz"), shape));
      add_amplitudes(effect, unit, static_cast<int>(term->harmonics), out);
      break;
    case EffectKind::kStep:
      out.push_back(parameter("time_s", term->time, "s"));
      out.push_back(parameter("replicate", term->replicate, "1"));
      add_shared(effect, unit, out);
      break;
    case EffectKind::kWitness:
      if (term->lag > 0.0) out.push_back(with_log_error(parameter("lag_s", term->lag, "s"), shape));
      if (term->from > 0.0) out.push_back(parameter("from_hz", term->from, "Hz"));
      if (std::isfinite(term->to)) out.push_back(parameter("to_hz", term->to, "Hz"));
      add_shared(effect, coupling_unit(subject.quantity, *subject.find(term->witness), *term), out);
      break;
    case EffectKind::kModulated: {
      const Modulation& last = effect.trial.fit.modulation.back();
      out.push_back(with_error(parameter("log_variance_slope", last.slope, "1"), last.error));
      break;
    }
    case EffectKind::kTelegraph: {
      const Subject& found = effect.trial.regression.subject();
      double jumps = 0.0;
      double seconds = 0.0;
      for (std::size_t k = 0; k < found.replicates(); ++k) {
        const std::vector<Eigen::Index>& times = found.courses[k].jumps;
        if (effect.effect == "step" && jumps == 0.0 && !times.empty()) {
          const double first = static_cast<double>(times.front()) / found.rate.value;
          out.push_back(parameter("time_s", first, "s"));
          out.push_back(parameter("replicate", static_cast<double>(k + 1), "1"));
        }
        jumps += static_cast<double>(times.size());
        seconds += found.seconds(k);
      }
      add_shared(effect, unit, out);
      out.push_back(parameter("jumps", jumps, "1"));
      if (effect.effect != "step") out.push_back(parameter("dwell_s", seconds / jumps, "s"));
      break;
    }
    case EffectKind::kOutliers:
      out.push_back(parameter("count", effect.suggestion.dof, "1"));
      break;
    case EffectKind::kOwnPowers:
      break;
  }
  return out;
}

}  // namespace imunoise::study
