#include "study/analysis/effect_parameters.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/estimate/whittle.h"
#include "core/inference/parameter_covariance.h"
#include "core/support/distributions.h"
#include "core/support/linear_algebra.h"
#include "study/analysis/vocabulary.h"

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

std::string unit_name(const Witness& witness) {
  return witness.unit.empty() ? unit_name(witness.quantity) : witness.unit;
}

// The number of a replicate as it was recorded and, of what follows a cut, when it begins.
std::string place_of(const Subject& subject, std::size_t replicate) {
  const std::size_t number = subject.parts[replicate].recorded + 1;
  if (subject.parts[replicate].first == 0) return std::to_string(number);
  return fmt::format("{} from {:.6g} s on", number, subject.begins(replicate));
}

// An effect of a fitted model, by its number.
struct FittedEffect {
  const Trial& trial;
  std::size_t number;
  double freedom = INFINITY;  // of the noise level, which is itself an estimate: Student's law

  const EffectTerm& term() const { return trial.regression.effects()[number]; }
  const Subject& subject() const { return trial.regression.subject(); }
};

// The coefficients, with their errors.
void add_shared(const FittedEffect& effect, const std::string& unit,
                std::vector<v1::EffectParameter>& out) {
  const Regression& regression = effect.trial.regression;
  const EffectCoefficients& found = effect.trial.fit.effects;
  const double stretch =
      std::isfinite(effect.freedom)
          ? student_quantile(0.5 + 0.5 * kConfidence, std::max(1.0, effect.freedom)) / reach()
          : 1.0;
  for (Eigen::Index i = regression.first(effect.number); i < regression.first(effect.number + 1);
       ++i) {
    const CoefficientName& name = regression.coefficients()[static_cast<std::size_t>(i)];
    const std::string label = name.replicate == CoefficientName::kAll
                                  ? name.name
                                  : fmt::format("{} in replicate {}", name.name,
                                                place_of(regression.subject(), name.replicate));
    out.push_back(with_error(parameter(label, found.value(i), unit),
                             stretch * std::sqrt(found.covariance(i, i))));
  }
}

// Amplitude of each multiple of a wave, over all replicates: root mean square less what noise adds.
void add_amplitudes(const FittedEffect& effect, const std::string& unit, int harmonics,
                    std::vector<v1::EffectParameter>& out) {
  const Regression& regression = effect.trial.regression;
  const Eigen::Index first = regression.first(effect.number);
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

// What was fitted of an effect whose form is known.
void add_fitted(const FittedEffect& effect, std::vector<v1::EffectParameter>& out) {
  const EffectTerm& term = effect.term();
  const Subject& subject = effect.subject();
  const std::string unit = unit_name(subject.quantity);
  switch (term.kind) {
    case EffectKind::kRamp:
      add_shared(effect, unit + "/s", out);
      break;
    case EffectKind::kLine:
      add_amplitudes(effect, unit, static_cast<int>(term.harmonics), out);
      break;
    case EffectKind::kWitness:
      add_shared(effect, coupling_unit(subject.quantity, *subject.find(term.witness), term), out);
      break;
    case EffectKind::kModulated: {
      const std::vector<EffectTerm>& all = effect.trial.regression.effects();
      const auto before =
          std::count_if(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(effect.number),
                        [](const EffectTerm& one) { return one.kind == EffectKind::kModulated; });
      const Modulation& found = effect.trial.fit.modulation[static_cast<std::size_t>(before)];
      const std::string below = unit_name(*subject.find(term.witness));
      out.push_back(with_error(parameter("log_variance_slope", found.slope / found.deviation,
                                         below == "1" ? below : "1/" + below),
                               found.error / found.deviation));
      break;
    }
    default:
      add_shared(effect, unit, out);
  }
}

// When a course leaves its first level.
void add_first_jump(const Subject& subject, std::vector<v1::EffectParameter>& out) {
  for (std::size_t k = 0; k < subject.replicates(); ++k) {
    const std::vector<Eigen::Index>& jumps = subject.courses[k].jumps;
    if (jumps.empty()) continue;
    const double after = static_cast<double>(jumps.front()) / subject.rate.value;
    out.push_back(parameter("time_s", subject.begins(k) + after, "s"));
    out.push_back(parameter("replicate", static_cast<double>(subject.parts[k].recorded + 1), "1"));
    return;
  }
}

void add_jumps(const Subject& subject, bool dwells, std::vector<v1::EffectParameter>& out) {
  double jumps = 0.0;
  double seconds = 0.0;
  for (std::size_t k = 0; k < subject.replicates(); ++k) {
    jumps += static_cast<double>(subject.courses[k].jumps.size());
    seconds += subject.seconds(k);
  }
  out.push_back(parameter("jumps", jumps, "1"));
  if (dwells) out.push_back(parameter("dwell_s", seconds / jumps, "s"));
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
      const std::string unit = unit_of(about[p].dimension, subject.quantity);
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
  std::string below = unit_name(witness) + (term.quadratic ? "²" : "");
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
  const double shape = effect.suggestion.shape_error;
  const Trial& trial = effect.trial;
  switch (term->kind) {
    case EffectKind::kWarmUp:
      out.push_back(with_log_error(parameter("tau_s", term->tau, "s"), shape));
      break;
    case EffectKind::kLine:
      out.push_back(with_error(parameter("frequency_hz", term->frequency, "Hz"), shape));
      break;
    case EffectKind::kStep:
      out.push_back(parameter("time_s", term->time, "s"));
      out.push_back(parameter("replicate", term->replicate, "1"));
      break;
    case EffectKind::kWitness:
      if (term->lag > 0.0) out.push_back(with_log_error(parameter("lag_s", term->lag, "s"), shape));
      if (term->from > 0.0) out.push_back(parameter("from_hz", term->from, "Hz"));
      if (std::isfinite(term->to)) out.push_back(parameter("to_hz", term->to, "Hz"));
      break;
    case EffectKind::kTelegraph:
      if (effect.effect == "step") add_first_jump(trial.regression.subject(), out);
      break;
    case EffectKind::kOutliers:
      out.push_back(parameter("count", effect.suggestion.dof, "1"));
      break;
    default:
      break;
  }
  add_fitted({trial, trial.regression.effects().size() - 1, effect.freedom}, out);
  if (term->kind == EffectKind::kTelegraph)
    add_jumps(trial.regression.subject(), effect.effect != "step", out);
  return out;
}

std::vector<v1::EffectParameter> fitted_parameters(const Trial& trial, std::size_t number) {
  std::vector<v1::EffectParameter> out;
  add_fitted({trial, number}, out);
  return out;
}

}  // namespace imunoise::study
