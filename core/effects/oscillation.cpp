// oscillation: a tone of constant amplitude whose phase and frequency keep changing.
//
// Its spectrum is that of noise that rings. Its amplitude tells them apart: noise that rings grows
// and fades, an oscillator does not. What it adds is no sum of waves, so it is no regressor: a
// filter follows it, and each sample becomes the normal number that says where it lies among what
// those before it make likely.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/effect/columns.h"
#include "core/effects/couplings/couplings.h"
#include "core/effects/distributions/wandering_tone.h"
#include "core/effects/draws.h"
#include "core/search/noise_bump.h"
#include "core/search/search_view.h"
#include "core/spectrum/bands.h"
#include "core/spectrum/cosine_transform.h"
#include "core/support/distributions.h"
#include "core/support/parallel.h"

namespace imunoise::effects {

const Effect& oscillation();

namespace {

using Index = Eigen::Index;
using Occupancy = WanderingTone::Occupancy;

enum OscillationParameter : std::size_t { kOscillationFrom, kOscillationTo, kOscillationAmplitude };

struct FoundTone : Found {
  explicit FoundTone(FittedTone tone) : fitted(std::move(tone)) {}
  FittedTone fitted;
};

NoiseBump band_of(const EffectTerm& term, Hertz rate) {
  return {term[kOscillationFrom] / rate.value, term[kOscillationTo] / rate.value};
}

// What a fit leaves of each replicate, whitened by the spectrum beside a band.
struct Whitened {
  std::vector<Eigen::ArrayXd> deviation;  // of the noise at each coefficient
  std::vector<ToneSeries> series;
};

Whitened whitened(const Current& current, const NoiseBump& band) {
  const std::size_t count = current.cosines.size();
  Whitened out{std::vector<Eigen::ArrayXd>(count), std::vector<ToneSeries>(count)};
  for_each_index(count, [&](std::size_t k) {
    Eigen::ArrayXd& deviation = out.deviation[k];
    deviation = spectrum_beside(current, band, k).sqrt();
    const Index middle = coefficients_below(0.5 * (band.from + band.to), deviation.size() + 1);
    out.series[k] = {inverse_cosine_transform((current.cosines[k].array() / deviation).matrix()),
                     deviation(std::min(middle, deviation.size() - 1))};
  });
  return out;
}

// How much of its time a tone is at each place, mean of the replicates.
Occupancy mean_occupancy(const FittedTone& fitted) {
  Occupancy out = Occupancy::Zero();
  for (const Occupancy& one : fitted.occupancy) out += one;
  return out / out.sum();
}

// What the noise of a fit gains over that beside a band, nats.
double gained_by_noise(const Current& current, const Whitened& beside) {
  double out = 0.0;
  for (std::size_t k = 0; k < current.cosines.size(); ++k) {
    const Eigen::ArrayXd ratio = beside.deviation[k].square() / current.spectrum[k];
    const Eigen::ArrayXd square = current.cosines[k].array().square();
    out += 0.5 * (ratio.log() + square * (1.0 - ratio) / beside.deviation[k].square()).sum();
  }
  return out;
}

// The band of a tone, and what it gains over the noise of the fit.
struct ToneBand {
  NoiseBump band;
  double gain = 0.0;
};

// Wider where the tone is often at its edge: what it does beyond is faint in the spectrum, but not
// to the filter.
ToneBand with_skirts(const Current& current, const NoiseBump& bump) {
  constexpr int kMostTimes = 3;
  constexpr double kOften = 0.03;
  constexpr double kWider = 0.3;  // of the width
  constexpr double kHighest = 0.49;
  ToneBand out{bump};
  for (int i = 0; i < kMostTimes; ++i) {
    NoiseBump& band = out.band;
    const Whitened white = whitened(current, band);
    const FittedTone fitted = fit_tone(band.from, band.to, white.series);
    out.gain = fitted.nats - gained_by_noise(current, white);
    if (!(out.gain > 0.0)) break;
    const Occupancy occupancy = mean_occupancy(fitted);
    const double skirt = kWider * (band.to - band.from);
    const NoiseBump before = band;
    if (occupancy(0) > kOften) band.from = std::max(0.1 * band.from, band.from - skirt);
    if (occupancy(occupancy.size() - 1) > kOften) band.to = std::min(kHighest, band.to + skirt);
    if (band.from == before.from && band.to == before.to) break;
  }
  return out;
}

std::shared_ptr<const Subject> without_oscillation(const EffectTerm& term, const Current& current) {
  auto out = std::make_shared<Subject>(current.subject());
  const NoiseBump band = band_of(term, out->rate);
  const std::size_t count = out->replicates();
  Whitened white = whitened(current, band);
  auto found = std::make_shared<FoundTone>(fit_tone(band.from, band.to, white.series));
  out->reshaped_nats.resize(count, 0.0);
  out->own_nats.resize(count, 0.0);
  for_each_index(count, [&](std::size_t k) {
    Eigen::VectorXd normal;
    const Eigen::VectorXd& samples = white.series[k].samples;
    const ToneFilter filter = found->fitted.filter(white.series[k], k);
    const ToneFilter::Passed passed = filter.pass(samples, normal);
    // The density of the samples over that of the normal numbers in their place.
    out->reshaped_nats[k] += passed.nats + 0.5 * (normal.squaredNorm() - samples.squaredNorm());
    // Within the band the noise is what is measured there, not what lies beside.
    const Eigen::VectorXd even = cosine_transform(std::move(normal));
    const Eigen::ArrayXd level = level_within(even, band);
    out->reshaped_nats[k] -= 0.5 * level.log().sum();
    out->own_nats[k] += static_cast<double>(WanderingTone::kPlaces - 1) + wide_bands(band);
    const Eigen::ArrayXd left = even.array() / level.sqrt() * white.deviation[k];
    Eigen::VectorXd cosines =
        (out->cosines[k].array() + left - current.cosines[k].array()).matrix();
    out->samples[k] = inverse_cosine_transform(cosines);
    out->cosines[k] = std::move(cosines);
  });
  out->keep(term, std::move(found));
  return out;
}

std::string_view oscillation_fault(const EffectTerm& term) {
  return term[kOscillationFrom] < term[kOscillationTo] ? "" : "from must lie below to";
}

Result<void> check_oscillation(const EffectTerm& term, const Subject& subject) {
  constexpr double kFewestWaves = 8.0;  // in the shortest replicate, by which the edges differ
  if (term[kOscillationTo] > 0.5 * subject.rate.value) return too_fast(term, subject);
  double shortest = subject.seconds(0);
  for (std::size_t k = 1; k < subject.replicates(); ++k)
    shortest = std::min(shortest, subject.seconds(k));
  if ((term[kOscillationTo] - term[kOscillationFrom]) * shortest < kFewestWaves)
    return unfit(term, fmt::format("from and to must lie at least {:.3g} Hz apart in replicates "
                                   "of {:.4g} s",
                                   kFewestWaves / shortest, shortest));
  return {};
}

// The frequency stays near the middle of the band and changes within some turns of what it
// deviates by.
void simulate_oscillation(const EffectTerm& term, const SimulatedReplicate& at,
                          Eigen::VectorXd& samples) {
  constexpr double kFullTurn = 2.0 * std::numbers::pi;
  const double rate = at.beside.rate.value;
  const double width = (term[kOscillationTo] - term[kOscillationFrom]) / rate;
  const double middle = 0.5 * (term[kOscillationTo] + term[kOscillationFrom]) / rate;
  const double deviation = width / 8.0;
  const double keep = std::exp(-0.5 * width);
  double away = at.random.normal();
  double phase = kFullTurn * uniform_number(at.random);
  for (double& x : samples) {
    x += term[kOscillationAmplitude] * std::cos(phase);
    phase += kFullTurn * (middle + deviation * away);
    away = keep * away + std::sqrt(1.0 - keep * keep) * at.random.normal();
  }
}

Suggestions search_oscillation(const SearchView& view) {
  constexpr double kSurely = -4.0;  // standard errors; a tone keeps to its amplitude
  constexpr double kShare = 0.6;    // of what stands out, at least, a tone
  const Current& current = view.current();
  const Subject& subject = view.subject();
  const std::optional<NoiseBump> bump = highest_bump(current);
  if (!bump) return {};
  const BumpTails tails = tails_of(current, *bump);
  const bool likely =
      tails.excess < kSurely * tails.error && tails.excess < kShare * kShare * tails.of_tone;
  const ToneBand found = likely ? with_skirts(current, *bump) : ToneBand{*bump};
  const EffectTerm term(
      oscillation(), "",
      {{"from", found.band.from * subject.rate.value}, {"to", found.band.to * subject.rate.value}});
  const double own = static_cast<double>(WanderingTone::kPlaces - 1) + wide_bands(found.band);
  return {{.cause = "oscillation",
           .added = rounded(term, 0.0, subject.rate),
           .score_nats = std::max(0.0, found.gain),
           .dof = 3.0 + own * static_cast<double>(subject.replicates())}};
}

// Whether a tone keeps each frequency for more than a thousand samples: one that drifts, as that of
// a fan does, looks so.
bool drifts(const TriedTerm& tried) {
  constexpr double kLongest = 1000.0;  // samples
  const auto* const found = tried.fitted.regression.subject().found_by<FoundTone>(*tried.term());
  return found != nullptr && found->fitted.tone.pace * kLongest < 1.0;
}

// Motion that no other sensor recorded, or that another sensor shows at the same frequencies.
void review_oscillation(const Current& current, TriedTerm& tried) {
  constexpr double kOnceIn = 1e-4;
  const Subject& subject = current.subject();
  for (const std::string_view id : unrecorded_couplings(subject)) {
    if (is_motion(id)) tried.could_be.push_back(id);
  }
  if (drifts(tried)) tried.could_be.push_back("wandering_line");
  const NoiseBump band = band_of(*tried.term(), subject.rate);
  const double limit =
      chi_square_quantile(1.0 - kOnceIn, 2.0 * static_cast<double>(subject.replicates()));
  for (const Witness& one : subject.witnesses) {
    if (!of_inertia(one.quantity) || !(alike_within(current, band, one) > limit)) continue;
    tried.could_be.push_back(may_share_motion(subject.quantity, one)
                                 ? "common_vibration"
                                 : coupling_effect(subject.quantity, one));
  }
}

std::vector<ReportedNumber> oscillation_numbers(const FittedEffect& effect) {
  const auto* const found = effect.subject().found_by<FoundTone>(effect.term());
  if (found == nullptr) return {};
  const WanderingTone& tone = found->fitted.tone;
  const std::string unit = unit_of(effect.term(), effect.subject());
  if (!found->fitted.seen) return {{"amplitude", 0.0, unit, 0.0, found->fitted.highest}};
  const double rate = effect.subject().rate.value;
  const Occupancy occupancy = mean_occupancy(found->fitted);
  double mean = 0.0;
  double square = 0.0;
  for (Index j = 0; j < occupancy.size(); ++j) {
    mean += occupancy(j) * tone.frequency(j);
    square += occupancy(j) * tone.frequency(j) * tone.frequency(j);
  }
  return {with_error({"amplitude", tone.amplitude, unit}, found->fitted.amplitude_error),
          {"mean_frequency_hz", mean * rate, "Hz"},
          {"frequency_deviation_hz", std::sqrt(std::max(0.0, square - mean * mean)) * rate, "Hz"}};
}

}  // namespace

const Effect& oscillation() {
  static const Effect kOscillation{
      .name = "oscillation",
      .title = "oscillation",
      .meaning = "Adds a tone of constant amplitude whose frequency keeps changing.",
      .parameters = {{.name = "from",
                      .meaning = "lowest frequency that the tone may take",
                      .unit = "Hz",
                      .required = true,
                      .reported = "from_hz",
                      .rounding = Rounding::kFourDigits},
                     {.name = "to",
                      .meaning = "highest frequency that the tone may take",
                      .unit = "Hz",
                      .required = true,
                      .reported = "to_hz",
                      .rounding = Rounding::kFourDigits},
                     {.name = "amplitude",
                      .meaning = "amplitude of the tone",
                      .reported = "amplitude",
                      .truth = true}},
      .causes = {{.id = "oscillation",
                  .title = "oscillation of unsteady frequency",
                  .physics =
                      "Something oscillates by itself, and the sampling is too slow or too "
                      "uneven to see it as one line: the drive of a gyroscope or a switching "
                      "supply above half the sampling rate, or a machine whose speed "
                      "varies.",
                  .record_next = "the same at another sampling rate: a tone from above half of it "
                                 "moves",
                  .looks_like = {"resonance", "wandering_line"},
                  .family = "oscillation"}},
      .fault = oscillation_fault,
      .check = check_oscillation,
      .cleaned = without_oscillation,
      .simulate = simulate_oscillation,
      .search = search_oscillation,
      .review = review_oscillation,
      .numbers = oscillation_numbers,
  };
  return kOscillation;
}

}  // namespace imunoise::effects
