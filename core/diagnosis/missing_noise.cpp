#include "core/diagnosis/missing_noise.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/diagnosis/bandwidth.h"
#include "core/diagnosis/markov_levels.h"
#include "core/diagnosis/missing_filter.h"
#include "core/diagnosis/missing_low_pass.h"
#include "core/diagnosis/missing_resonance.h"
#include "core/diagnosis/score_space.h"
#include "core/diagnosis/steadiness.h"
#include "core/model/similar_term.h"
#include "core/search/noise_bump.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

template <class P>
bool has(const Model& model) {
  return std::any_of(model.terms.begin(), model.terms.end(),
                     [](const Term& term) { return std::holds_alternative<P>(term.process); });
}

template <class P>
void add_simple(const Current& current, const ScoreSpace& space, std::string_view cause,
                Suggestions& out) {
  if (!has<P>(current.fit.model.noise)) add_best(current, space, cause, {Process(P{})}, out);
}

std::vector<Process> markov_family(double longest) {
  constexpr int kEachOctave = 3;
  std::vector<Process> out;
  const int last = static_cast<int>(kEachOctave * std::log2(longest));
  for (int i = 0; i <= last; ++i)
    out.emplace_back(Ar1{1.0, std::exp(-1.0 / std::exp2(static_cast<double>(i) / kEachOctave))});
  return out;
}

// White noise through two filters of first order in a row, the slower one of any time constant up
// to `longest`, the other `ratio` times faster.
std::vector<Process> cascade_family(double ratio, double longest) {
  constexpr int kEachOctave = 2;
  std::vector<Process> out;
  const int last = static_cast<int>(kEachOctave * std::log2(longest));
  for (int i = kEachOctave; i <= last; ++i) {
    const double time = std::exp2(static_cast<double>(i) / kEachOctave);
    const double slow = std::exp(-1.0 / time);
    const double fast = std::exp(-ratio / time);
    out.emplace_back(Ar2{1.0, (slow + fast) / (1.0 + slow * fast), -slow * fast});
  }
  return out;
}

bool peaks(const Model& noise) {
  return std::all_of(noise.terms.begin(), noise.terms.end(), [](const Term& term) {
    const auto* resonance = std::get_if<Resonance>(&term.process);
    return resonance == nullptr || resonance->has_peak();
  });
}

// A second-order autoregression. It contains Markov noise and the resonance, so that it is offered
// only where it explains clearly more than both: with one parameter more chance gains 6 nats once
// in 2,000. A resonance without a peak is noise behind two lags by another name.
void add_second_order(const Current& current, const ScoreSpace& space, double longest,
                      Suggestions& out) {
  constexpr double kClearly = 6.0;
  Suggestions found;
  for (const double ratio : {1.0, 6.0})
    add_best(current, space, "second_order", cascade_family(ratio, longest), found);
  if (found.empty()) return;
  Suggestion best = *std::max_element(
      found.begin(), found.end(),
      [](const Suggestion& a, const Suggestion& b) { return a.score_nats < b.score_nats; });
  best.search.path = 0.0;
  for (const Suggestion& one : found) best.search.path += one.search.path;
  const auto fitted = [&](const Suggestion& of) {
    return whittle(std::get<NoiseChange>(of.added).start, current.pooled);
  };
  const double reached = fitted(best).objective;
  const bool special = std::any_of(out.begin(), out.end(), [&](const Suggestion& other) {
    if (other.cause != "gauss_markov" && other.cause != "resonance") return false;
    const WhittleEstimate simpler = fitted(other);
    return peaks(simpler.model) && simpler.objective < reached + kClearly;
  });
  if (special) best.score_nats = 0.0;
  out.push_back(std::move(best));
}

// A power law of any slope. It contains flicker noise, nearly a walk, and over a narrow band a
// Markov process, so that it is offered only where it explains clearly more than any of them.
void add_power_law(const Current& current, const ScoreSpace& space, Suggestions& out) {
  constexpr double kClearly = 6.0;
  if (has<PowerLaw>(current.fit.model.noise)) return;
  std::vector<Process> family;
  for (double slope = 0.3; slope < 1.9; slope += 0.1) family.emplace_back(PowerLaw{1.0, slope});
  Suggestions found;
  add_best(current, space, "power_law", family, found);
  const auto objective = [&](const Suggestion& of) {
    return whittle(std::get<NoiseChange>(of.added).start, current.pooled).objective;
  };
  const double reached = objective(found.front());
  static constexpr std::string_view kSpecial[] = {"random_walk", "flicker", "gauss_markov",
                                                  "second_order"};
  const bool special = std::any_of(out.begin(), out.end(), [&](const Suggestion& other) {
    const bool slow =
        std::find(std::begin(kSpecial), std::end(kSpecial), other.cause) != std::end(kSpecial);
    return slow && other.score_nats > 0.0 && objective(other) < reached + kClearly;
  });
  if (special) found.front().score_nats = 0.0;
  out.push_back(std::move(found.front()));
}

// Heat does not move a sensor faster than this.
constexpr double kFastestHeat = 10.0;  // s

// By its correlation time, or by the frequency at which it rings.
bool as_slow_as_heat(const Process& process, Hertz rate) {
  const std::vector<DerivedQuantity> all = derived(process, rate);
  return std::any_of(all.begin(), all.end(), [](const DerivedQuantity& one) {
    const bool rings = one.coefficient == Coefficient::kFrequency;
    return rings ? 2.0 * std::numbers::pi * one.value * kFastestHeat < 1.0
                 : one.coefficient == Coefficient::kCorrelationTime && one.value > kFastestHeat;
  });
}

// Structures that are bolted or glued lose at least this part of their critical damping. A line as
// narrow as a resonance below it may be a machine that starts and stops: its spectrum is the same.
bool rings_too_long(const Process& process) {
  constexpr double kLightest = 0.005;
  const std::vector<DerivedQuantity> all = derived(process, Hertz{1.0});
  return std::any_of(all.begin(), all.end(), [](const DerivedQuantity& one) {
    return one.coefficient == Coefficient::kDampingRatio && one.value < kLightest;
  });
}

// A Markov process may jump between two levels in truth.
void name_markov(TriedTerm& tried) {
  const double levels = two_level_gain(tried.fitted.regression, tried.fitted.fit);
  constexpr double kClearly = 5.0;
  if (levels < kClearly) return;
  tried.cause = "telegraph";
  tried.likelihood_gain += levels - kClearly;  // so much chance may gain
}

}  // namespace

std::vector<Cause> noise_causes() {
  return {
      {"quantisation",
       "quantisation of an accumulated angle or velocity",
       "The converter rounds the integral of the signal; differences of rounding errors fall off "
       "as "
       "1/τ².",
       "the same at a finer resolution, or a few minutes with slow motion that exercises many "
       "codes",
       {"white_noise", "line"},
       "quantisation"},
      {"white_noise",
       "white noise",
       "Thermal noise of the sensing element and its electronics.",
       "a minute at the highest rate the device has",
       {"outliers", "quantisation"},
       "white_noise"},
      {"random_walk",
       "random walk",
       "The bias changes by independent increments, through charge traps and creep.",
       "longer, together with the temperature",
       {"gauss_markov", "temperature", "step", "flicker"},
       "random_walk",
       true},
      {"gauss_markov",
       "first-order Markov noise",
       "A fluctuation with a correlation time: bias instability.",
       "ten times its correlation time, together with the temperature",
       {"flicker", "telegraph", "temperature", "low_pass"},
       "gauss_markov",
       false,
       true},
      {"second_order",
       "noise behind two lags",
       "A fluctuation that passes two lags in a row: temperature behind a housing, or a filter of "
       "second order.",
       "ten times its longer time constant, together with the temperature",
       {"gauss_markov", "temperature", "low_pass"},
       "second_order",
       false,
       true},
      {"flicker",
       "flicker noise",
       "1/f noise of the electronics: many traps of many time constants.",
       "longer: one Markov process and flicker noise differ only over several decades",
       {"gauss_markov", "random_walk"},
       "flicker",
       true,
       true},
      {"power_law",
       "power-law noise",
       "Noise whose power falls as a power of frequency, neither white noise, flicker noise nor a "
       "walk: relaxation and diffusion with many time constants.",
       "longer, together with the temperature",
       {"flicker", "random_walk", "gauss_markov"},
       "power_law",
       true,
       true},
      {"low_pass",
       "sensor bandwidth",
       "A filter on the chip removes the fastest noise; the spectrum rolls off.",
       "the same with the filter set differently",
       {"gauss_markov", "quantisation"},
       "low_pass"},
      {"resonance",
       "resonance",
       "The sensing element, its mount or the bench rings when noise excites it.",
       "the same on another mount, and with a tap on the bench",
       {"line", "gauss_markov", "oscillation"},
       "resonance",
       false,
       true},
      {"switched_line",
       "vibration that switches on and off",
       "A machine on the same bench starts and stops; while it runs, it vibrates at one frequency.",
       "the same with machines off, one after the other, or the spectrum of short stretches",
       {"resonance", "line"},
       "switched_line"},
  };
}

void review_noise(const Current& current, TriedTerm& tried) {
  constexpr double kUnsteady = 1e-3;
  const FittedModel& with = tried.fitted;
  const Process& added = std::get<NoiseChange>(tried.suggestion.added).added;
  const Model& noise = with.fit.model.noise;
  const auto term = similar_term(noise, added);
  const Process& fitted = term ? noise.terms[*term].process : added;
  const bool lags = tried.cause == "gauss_markov" || tried.cause == "second_order" ||
                    (tried.cause == "resonance" && hardly_rings(fitted));
  if (lags && is_bandwidth(fitted, noise)) {
    tried.cause = "low_pass";
  } else if (tried.cause == "gauss_markov") {
    name_markov(tried);
  }
  if (tried.cause == "telegraph") return;
  if (tried.cause == "gauss_markov" || tried.cause == "second_order")
    tried.slow = as_slow_as_heat(fitted, current.subject().rate);
  if (tried.cause == "resonance") {
    if (rings_too_long(fitted)) tried.could_be.push_back("switched_line");
    if (made_of_lines(with.regression, with.fit, added)) tried.could_be.push_back("line");
    if (may_be_tone(current)) tried.could_be.push_back("oscillation");
  }
  tried.steady = steadiness(with.regression, with.fit, added).p_value > kUnsteady;
}

Suggestions search_noise(const Current& current) {
  const ScoreSpace space(current);
  Suggestions out;
  add_simple<WhiteNoise>(current, space, "white_noise", out);
  add_simple<QuantisationNoise>(current, space, "quantisation", out);
  add_simple<RandomWalk>(current, space, "random_walk", out);
  add_simple<Flicker>(current, space, "flicker", out);
  const auto longest = static_cast<double>(current.subject().length(current.longest()));
  add_best(current, space, "gauss_markov", markov_family(longest / 4.0), out);
  for (Suggestion& one : search_resonances(current, space)) out.push_back(std::move(one));
  add_second_order(current, space, longest / 4.0, out);
  add_power_law(current, space, out);
  for (Suggestion& one : search_filters(current)) out.push_back(std::move(one));
  Suggestion low_pass = search_low_pass(current, out);
  out.push_back(std::move(low_pass));
  return out;
}

}  // namespace imunoise
