// witness: proportional to another channel, as it is, filtered, or behind a lag.

#include "core/effects/couplings/witness.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/effect/columns.h"
#include "core/effect/filters.h"
#include "core/effect/witness_spectrum.h"
#include "core/effects/couplings/couplings.h"
#include "core/spectrum/cosine_transform.h"

namespace imunoise::effects {

namespace {

using Index = Eigen::Index;

bool is_on(const EffectTerm& term, WitnessParameter flag) { return term[flag] != 0.0; }

std::string_view witness_fault(const EffectTerm& term) {
  if (term.given(kWitnessVertex) && !is_on(term, kWitnessQuadratic))
    return "only a quadratic coupling has a vertex";
  if (!(term[kWitnessFrom] < term[kWitnessTo])) return "from must lie below to";
  const double lowest = std::exp2(1.0 - term[kWitnessOctaves]) * term[kWitnessTo];
  return term[kWitnessFrom] < lowest ? "" : "from must lie within the lowest octave";
}

Result<void> check_witness(const EffectTerm& term, const Subject& subject) {
  if (term[kWitnessFrom] >= 0.5 * subject.rate.value) return too_fast(term, subject);
  return {};
}

// The movements of a transformed series between two frequencies, in Hz.
void keep_between(Eigen::VectorXd& cosines, double from, double to, double rate) {
  const auto per_hertz = 2.0 * static_cast<double>(cosines.size() + 1) / rate;
  const auto n = static_cast<double>(cosines.size());
  const auto first = static_cast<Index>(std::min(from * per_hertz, n));
  const auto last = static_cast<Index>(std::min(to * per_hertz, n));
  cosines.head(first).setZero();
  cosines.tail(cosines.size() - last).setZero();
}

bool as_it_is(const EffectTerm& term) {
  return !is_on(term, kWitnessQuadratic) && !is_on(term, kWitnessDerivative) &&
         !(term[kWitnessLag] > 0.0);
}

// The witness as the term takes it: behind its lag, squared, its change.
SharedVector witness_samples(const EffectTerm& term, const Witness& channel, std::size_t k,
                             double rate) {
  if (as_it_is(term)) return channel.samples[k];
  const double lag = term[kWitnessLag];
  Eigen::VectorXd x =
      lag > 0.0 ? lagged(channel.samples[k], lag * rate) : Eigen::VectorXd(channel.samples[k]);
  if (is_on(term, kWitnessQuadratic)) {
    const double vertex = term.given(kWitnessVertex) ? term[kWitnessVertex] : mean_level(channel);
    x = (x.array() + (level(channel, k) - vertex)).square();
  }
  if (is_on(term, kWitnessDerivative)) x = rate_of_change(x, rate);
  return x;
}

// A column an octave, the slowest first. All frequencies at once are the samples' own.
Columns witness_columns(const EffectTerm& term, const Witness& channel, std::size_t k,
                        double rate) {
  const SharedVector samples = witness_samples(term, channel, k, rate);
  const bool transformed = as_it_is(term) && !channel.cosines.empty();
  const SharedVector cosines =
      transformed ? channel.cosines[k] : SharedVector(cosine_transform(samples));
  const double octaves = term[kWitnessOctaves];
  if (!(term[kWitnessFrom] > 0.0) && !std::isfinite(term[kWitnessTo]) && octaves == 1.0)
    return {{cosines}, {}, {samples}};
  const double top = std::isfinite(term[kWitnessTo]) ? term[kWitnessTo] : 0.5 * rate;
  Columns out;
  double from = term[kWitnessFrom];
  for (double octave = octaves - 1.0; octave >= 0.0; --octave) {
    const double to = top * std::exp2(-octave);
    Eigen::VectorXd part = cosines;
    keep_between(part, from, to, rate);
    out.cosines.emplace_back(std::move(part));
    from = to;
  }
  return out;
}

// The channel, less noise of its own.
Witness heard(const EffectTerm& term, const Subject& subject) {
  const Witness& channel = *subject.find(term.witness);
  const double density = term[kWitnessNoise];
  return density > 0.0 ? without_noise(channel, density * density * subject.rate.value) : channel;
}

Regressors witness_regressors(const EffectTerm& term, const Subject& subject) {
  const Witness channel = heard(term, subject);
  const std::string name = is_on(term, kWitnessQuadratic) ? "quadratic_coefficient" : "coefficient";
  std::vector<std::string> names;
  const auto octaves = static_cast<int>(term[kWitnessOctaves]);
  for (int i = 1; i <= octaves; ++i)
    names.push_back(octaves == 1 ? name : fmt::format("{}_{}", name, i));
  return in_all(subject, is_on(term, kWitnessOwn), names, [&](std::size_t k) {
    return witness_columns(term, channel, k, subject.rate.value);
  });
}

void simulate_witness(const EffectTerm& term, const SimulatedReplicate& at,
                      Eigen::VectorXd& samples) {
  const double own = is_on(term, kWitnessOwn) ? at.random.normal() : 1.0;
  const Columns columns =
      witness_columns(term, heard(term, at.beside), at.replicate, at.beside.rate.value);
  add_effect(term, at.beside, at.replicate, columns,
             Eigen::VectorXd::Constant(static_cast<Index>(columns.cosines.size()),
                                       own * term[kWitnessCoefficient]),
             samples);
}

std::string witness_unit(const EffectTerm& term, const Subject& subject) {
  std::string below = unit_of(*subject.find(term.witness));
  if (is_on(term, kWitnessQuadratic)) below = in_brackets(below) + "²";
  if (is_on(term, kWitnessDerivative)) below = "(" + below + "/s)";
  return per(std::string(si_symbol(subject.quantity)), below);
}

// A vertex and a noise have the witness's unit.
void add_its_own(const TriedTerm& tried, std::vector<ReportedNumber>& first,
                 std::vector<ReportedNumber>& last) {
  const EffectTerm& term = *tried.term();
  const Witness& channel = *tried.fitted.regression.subject().find(term.witness);
  const double error = tried.suggestion.shape_error;
  if (term.given(kWitnessVertex))
    first.push_back(with_error({"vertex", term[kWitnessVertex], unit_of(channel)}, error));
  if (term.given(kWitnessNoise))
    last.push_back(with_log_error(
        {"noise_of_" + channel.name, term[kWitnessNoise], unit_of(channel) + "/√Hz"}, error));
}

// What comes before its cause has another; a small part of a motion may leak in from another axis.
void review_witness(const Current&, TriedTerm& tried) {
  if (tried.suggestion.backwards) tried.could_be.push_back("gauss_markov");
  if (tried.suggestion.coupling == MotionCoupling::kBand && may_leak(tried.fitted))
    tried.could_be.push_back("cross_axis");
}

}  // namespace

const Effect& witness() {
  static const Effect kWitness{
      .name = "witness",
      .title = "coupling to a channel",
      .meaning =
          "Adds another channel times a coefficient, behind a lag, between two frequencies, "
          "squared, or its change per second.",
      .witness = true,
      .parameters =
          {{.name = "lag",
            .meaning = "time constant of a first-order lag",
            .unit = "s",
            .reported = "lag_s",
            .rounding = Rounding::kFourDigits,
            .error = ShapeError::kLogarithm},
           {.name = "from",
            .meaning = "only movements of the witness faster than this",
            .unit = "Hz",
            .reported = "from_hz",
            .rounding = Rounding::kFourDigits},
           {.name = "to",
            .meaning = "only movements of the witness slower than this",
            .unit = "Hz",
            .absent = std::numeric_limits<double>::infinity(),
            .reported = "to_hz",
            .rounding = Rounding::kFourDigits},
           {.name = "octaves",
            .meaning = "number of coefficients: one per octave below to; the first one also covers "
                       "everything slower",
            .form = ParameterForm::kWholeNumber,
            .absent = 1.0,
            .lower = 1.0,
            .upper = 24.0},
           {.name = "quadratic", .meaning = "the witness squared", .form = ParameterForm::kFlag},
           {.name = "vertex",
            .meaning = "value of the witness at the vertex of a quadratic coupling; without it, "
                       "its mean",
            .unit = "SI unit of the witness",
            .absent = std::numeric_limits<double>::infinity(),
            .lower = -1e15,
            .rounding = Rounding::kByError},
           {.name = "derivative",
            .meaning = "the change of the witness per second",
            .form = ParameterForm::kFlag},
           {.name = "own",
            .meaning = "separate coefficient in each replicate",
            .form = ParameterForm::kFlag},
           {.name = "noise",
            .meaning = "density of the witness's own white noise, which the effect does not follow",
            .unit = "SI unit of the witness/√Hz",
            .rounding = Rounding::kFourDigits,
            .error = ShapeError::kLogarithm},
           {.name = "coefficient",
            .meaning = "output per unit of the witness; with own, its standard deviation over the "
                       "replicates",
            .lower = -1e15,
            .reported = "coefficient",
            .truth = true}},
      .coefficient = "coefficient",
      .causes = coupling_causes(),
      .fault = witness_fault,
      .check = check_witness,
      .unit = witness_unit,
      .regressors = witness_regressors,
      .simulate = simulate_witness,
      .search = search_witness,
      .review = review_witness,
      .more_numbers = add_its_own,
  };
  return kWitness;
}

}  // namespace imunoise::effects
