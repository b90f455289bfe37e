// line: a sine wave, and multiples of its frequency.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include "core/effect/columns.h"
#include "core/search/peak.h"
#include "core/search/search_view.h"
#include "core/search/wave_scores.h"
#include "core/support/linear_algebra.h"
#include "core/support/parallel.h"

namespace imunoise::effects {

const Effect& line();

namespace {

using Index = Eigen::Index;

enum LineParameter : std::size_t { kLineFrequency, kLineHarmonics, kLineAmplitude, kLinePhase };

int harmonics_of(const EffectTerm& term) { return static_cast<int>(term[kLineHarmonics]); }

Shape line_shape(const EffectTerm& term, const Subject& subject) {
  return waves(term[kLineFrequency] / subject.rate.value, harmonics_of(term));
}

Result<void> check_line(const EffectTerm& term, const Subject& subject) {
  if (term[kLineFrequency] * term[kLineHarmonics] > 0.5 * subject.rate.value)
    return too_fast(term, subject);
  double longest = 0.0;  // s
  for (std::size_t k = 0; k < subject.replicates(); ++k)
    longest = std::max(longest, subject.seconds(k));
  if (term[kLineFrequency] * longest < 0.5)
    return unfit(term, fmt::format("no replicate is as long as half a period ({:.6g} s)", longest));
  return {};
}

Regressors line_regressors(const EffectTerm& term, const Subject& subject) {
  std::vector<std::string> names;
  for (int h = 1; h <= harmonics_of(term); ++h) {
    names.push_back(fmt::format("cosine_{}", h));
    names.push_back(fmt::format("sine_{}", h));
  }
  return shaped(subject, true, names, [&](Index) { return line_shape(term, subject); });
}

void add_line(const EffectTerm& term, const Subject& subject, std::size_t,
              const Eigen::VectorXd& coefficients, Eigen::VectorXd& to) {
  line_shape(term, subject).add(coefficients, to);
}

constexpr double kFewestTurns =
    8.0;  // of a machine in a replicate: fewer waves in tune are any course
constexpr double kDrawnPhase = -1.0;
constexpr double kSlowestMachine = 0.02;  // Hz; a building does not sway as slowly either

// The multiple h has the amplitude of the fundamental over h. Phases are those of sines at the
// first sample: drawn, or h times the given one.
void simulate_line(const EffectTerm& term, const SimulatedReplicate& at, Eigen::VectorXd& samples) {
  Eigen::VectorXd coefficients(2 * harmonics_of(term));
  for (int h = 0; h < harmonics_of(term); ++h) {
    const std::complex<double> drawn(at.random.normal(), at.random.normal());
    const double phase =
        term[kLinePhase] == kDrawnPhase ? std::arg(drawn) : (h + 1) * term[kLinePhase];
    const double amplitude = term[kLineAmplitude] / (h + 1);
    coefficients(2 * h) = amplitude * std::sin(phase);
    coefficients(2 * h + 1) = amplitude * std::cos(phase);
  }
  add_line(term, at.beside, at.replicate, coefficients, samples);
}

// Amplitude of each multiple, over all replicates: root mean square less what noise adds.
std::vector<ReportedNumber> line_numbers(const FittedEffect& effect) {
  const Index first = effect.model.regression.first(effect.number);
  const EffectCoefficients& found = effect.model.fit.effects;
  const int harmonics = harmonics_of(effect.term());
  const std::size_t count = effect.subject().replicates();
  const auto replicates = static_cast<double>(count);
  std::vector<ReportedNumber> out;
  for (int h = 0; h < harmonics; ++h) {
    double square = 0.0;
    double noise = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
      const Index at = first + 2 * (static_cast<Index>(k) * harmonics + h);
      square += found.value.segment(at, 2).squaredNorm();
      noise += found.covariance(at, at) + found.covariance(at + 1, at + 1);
    }
    const double amplitude = std::sqrt(std::max(0.0, square - noise) / replicates);
    const double error = std::sqrt(0.5 * noise) / replicates;
    out.push_back(with_error({harmonics == 1 ? "amplitude" : fmt::format("amplitude_{}", h + 1),
                              amplitude, unit_of(effect.term(), effect.subject())},
                             error));
  }
  return out;
}

Stretch whole(const Subject& subject, std::size_t k) { return {k, 0, subject.length(k)}; }

// Log-likelihood gained at one frequency, cycles per sample, over all replicates.
double line_gain(const Current& current, double f) {
  double out = 0.0;
  for (std::size_t k = 0; k < current.weighted.size(); ++k)
    out += wave_gain(current, whole(current.subject(), k), f);
  return out;
}

// The same by least squares. Where only few periods lie in a replicate, the two quadratures of a
// wave are not orthogonal, and the noise is not the same around it.
double slow_gain(const Current& current, double f) {
  std::vector<double> each(current.cosines.size());
  for_each_index(each.size(), [&](std::size_t k) {
    const Index samples = current.subject().length(k);
    if (f * static_cast<double>(samples) < kFewestPeriods) return;
    const Eigen::MatrixXd columns = waves(f, 1).cosines(samples);
    const Eigen::MatrixXd weighted = (columns.array().colwise() / current.spectrum[k]).matrix();
    const Eigen::VectorXd moment = weighted.transpose() * current.cosines[k];
    each[k] = 0.5 * moment.dot(solve_symmetric(weighted.transpose() * columns, moment));
  });
  return std::accumulate(each.begin(), each.end(), 0.0);
}

// True where a frequency is that of 50 or 60 Hz mains or of a low multiple, folded where that is
// above half the sampling rate; mains wander by 0.1 %.
bool is_mains(double hertz, double rate, double resolution) {
  for (const double mains : {50.0, 60.0}) {
    for (int multiple = 1; multiple <= 4; ++multiple) {
      const double high = mains * multiple;
      const double folded = std::abs(high - rate * std::round(high / rate));
      if (folded > 0.0 && std::abs(folded - hertz) <= 0.001 * high + resolution) return true;
    }
  }
  return false;
}

// Of the shortest and the longest replicate, samples.
std::pair<Index, Index> lengths(const Subject& subject) {
  std::pair<Index, Index> out{subject.length(0), subject.length(0)};
  for (std::size_t k = 0; k < subject.replicates(); ++k) {
    out.first = std::min(out.first, subject.length(k));
    out.second = std::max(out.second, subject.length(k));
  }
  return out;
}

// The wave that explains most.
Suggestion best_wave(const Current& current) {
  const Subject& subject = current.subject();
  const auto [shortest, longest] = lengths(subject);
  const Index padded = padded_length(2 * longest);
  const AllWaves waves = all_wave_gains(current, padded);
  Suggestion out{.cause = "line", .added = EffectTerm(line())};
  if (waves.gain.size() == 0) return out;
  Index best = 0;
  waves.gain.maxCoeff(&best);
  const double step = 1.0 / static_cast<double>(padded);
  const double near = static_cast<double>(waves.first + best) * step;
  constexpr double kFewPeriods = 20.0;
  constexpr Index kMostSamples = 1 << 21;  // of a replicate: least squares keeps four columns of it
  const bool slow = longest <= kMostSamples && near * static_cast<double>(shortest) < kFewPeriods;
  const Peak peak = peak_between(near - step, near + step, 0.25 * step, [&](double at) {
    return slow ? slow_gain(current, at) : line_gain(current, at);
  });
  const double rate = subject.rate.value;
  const double hertz = peak.at * rate;
  out.added = EffectTerm(line(), "", {{"f", hertz}});
  out.score_nats = peak.gain;
  out.dof = 2.0 * static_cast<double>(subject.replicates());
  out.shape_error = peak.error * rate;
  for (std::size_t k = 0; k < subject.replicates(); ++k)
    out.information +=
        0.5 * static_cast<double>(subject.length(k)) / noise_level(current, k, peak.at);
  // A wave's score turns by π T/√3 rad per Hz: the spread of time within a replicate.
  out.search.path = 0.5 * std::numbers::pi / std::sqrt(3.0) * static_cast<double>(longest);
  if (hertz < kSlowestMachine) out.cause = "slow_cycle";
  if (is_mains(hertz, rate, rate / static_cast<double>(longest))) out.cause = "mains_alias";
  return out;
}

// Multiples of a fundamental, which may be any of the first four of them; `f` in cycles per sample.
std::optional<Suggestion> best_harmonics(const Current& current, const Suggestion& wave, double f) {
  const Subject& subject = current.subject();
  const Index shortest = lengths(subject).first;
  for (int order = 1; order <= 4; ++order) {
    const double fundamental = f / order;
    const int most = std::min(12, static_cast<int>(0.495 / fundamental));
    if (fundamental * static_cast<double>(shortest) < kFewestTurns || most < 2) continue;
    double total = 0.0;
    double kept = 0.0;
    int count = 0;
    int shown = 0;
    for (int h = 1; h <= most; ++h) {
      const double gain = h == order ? wave.score_nats : line_gain(current, h * fundamental);
      total += gain;
      constexpr double kShownNats = 6.0;
      if (gain < kShownNats + 0.5 * wave.dof) continue;
      ++shown;
      kept = total;
      count = h;
    }
    if (shown < 2 || 2 * shown < count) continue;
    Suggestion out{.cause = "harmonics",
                   .added = EffectTerm(line(), "",
                                       {{"f", fundamental * subject.rate.value},
                                        {"harmonics", static_cast<double>(count)}}),
                   .score_nats = kept,
                   .dof = wave.dof * count,
                   .search = wave.search,
                   .shape_error = wave.shape_error / order};
    out.search.log_places = std::log(4.0 * most);
    return out;
  }
  return std::nullopt;
}

Suggestions search_line(const SearchView& view) {
  const Current& current = view.current();
  const Suggestion wave = best_wave(current);
  const double hertz = std::get<EffectTerm>(wave.added)[kLineFrequency];
  if (!(hertz > 0.0)) return {};
  Suggestions out{wave};
  if (auto more = best_harmonics(current, wave, hertz / view.subject().rate.value))
    out.push_back(std::move(*more));
  return out;
}

}  // namespace

const Effect& line() {
  static const Effect kLine{
      .name = "line",
      .title = "sine wave",
      .meaning = "Adds a line and its harmonics, with separate phases in each replicate.",
      .parameters = {{.name = "f",
                      .meaning = "frequency",
                      .unit = "Hz",
                      .required = true,
                      .reported = "frequency_hz",
                      .rounding = Rounding::kByError,
                      .error = ShapeError::kAbsolute},
                     {.name = "harmonics",
                      .meaning = "number of multiples of the frequency, itself included",
                      .form = ParameterForm::kWholeNumber,
                      .absent = 1.0,
                      .lower = 1.0,
                      .upper = 50.0},
                     {.name = "amplitude",
                      .meaning = "amplitude of the fundamental; the multiple h has an h-th of it",
                      .reported = "amplitude",
                      .truth = true},
                     {.name = "phase",
                      .meaning = "phase of the fundamental, a sine, at the first sample of each "
                                 "replicate; drawn for each where it is not given",
                      .unit = "rad",
                      .absent = kDrawnPhase,
                      .upper = 2.0 * std::numbers::pi,
                      .truth = true}},
      .coefficient = "amplitude",
      .anywhere = true,
      .fewest_periods = kFewestPeriods,
      .causes = {{.id = "line",
                  .title = "sine wave",
                  .physics = "A fan, a pump or a building vibrates at one frequency.",
                  .record_next = "the same with fans and pumps off, one after the other",
                  .looks_like = {"resonance", "harmonics", "mains_alias"},
                  .family = "line"},
                 {.id = "slow_cycle",
                  .title = "slow cycle",
                  .physics = "A thermostat switches a heater, an air conditioning or an oven at "
                             "regular intervals, and the sensor feels it.",
                  .record_next = "the same with the temperature recorded, or with heating and air "
                                 "conditioning off",
                  .looks_like = {"line", "temperature", "random_walk"},
                  .family = "line",
                  .slow = true},
                 {.id = "harmonics",
                  .title = "sine wave and its multiples",
                  .physics = "A rotating machine shakes the bench at its speed and at multiples of "
                             "it.",
                  .record_next = "the same with machines off, one after the other",
                  .looks_like = {"line", "mains_alias"},
                  .family = "line"},
                 {.id = "mains_alias",
                  .title = "mains frequency",
                  .physics =
                      "Cables or humming devices couple in the mains frequency or a multiple; if "
                      "that lies above half the sampling rate, its alias shows.",
                  .record_next =
                      "the same on a battery: it disappears; at another sampling rate an "
                      "alias moves",
                  .looks_like = {"line"},
                  .family = "line"}},
      .check = check_line,
      .regressors = line_regressors,
      .add = add_line,
      .simulate = simulate_line,
      .search = search_line,
      .numbers = line_numbers,
  };
  return kLine;
}

}  // namespace imunoise::effects
