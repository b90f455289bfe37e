// wander: a wave whose frequency differs between replicates and moves slowly within one.
//
// Each replicate has a track of its own, found in its samples (core/search/wave_track.h); two
// coefficients a replicate are left to fit.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/effect/columns.h"
#include "core/effects/draws.h"
#include "core/inference/goodness.h"
#include "core/search/search_view.h"
#include "core/search/wave_track.h"
#include "core/spectrum/cosine_transform.h"
#include "core/support/parallel.h"

namespace imunoise::effects {

const Effect& wander();

namespace {

using Index = Eigen::Index;

enum WanderParameter : std::size_t { kWanderFrom, kWanderTo, kWanderAmplitude };

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr Index kShortestPiece = 256;     // samples
constexpr double kFewestWandering = 8.0;  // periods: of fewer, none is seen to move
constexpr std::array<double, 3> kWidths{0.003, 0.015, 0.08};  // of the frequency, to either side

// Into how many pieces replicates may be cut. A single replicate of one piece would hold a line.
std::vector<Index> piece_counts(const Subject& subject) {
  Index shortest = subject.length(0);
  for (std::size_t k = 1; k < subject.replicates(); ++k)
    shortest = std::min(shortest, subject.length(k));
  std::vector<Index> out;
  for (const Index count : {1, 4, 16, 64}) {
    if (count == 1 ? subject.replicates() > 1 : shortest / count >= kShortestPiece)
      out.push_back(count);
  }
  return out;
}

std::vector<WavePieces> all_pieces(const Current& current, Index count) {
  std::vector<WavePieces> out(current.subject().replicates());
  for_each_index(out.size(), [&](std::size_t k) { out[k] = wave_pieces(current, k, count); });
  return out;
}

// What the term found: columns a replicate, and what they cost.
struct FoundTracks final : Found {
  std::vector<Columns> columns;
  std::vector<double> log_tracks;  // a replicate each
  double frequency = 0.0;          // mean of all pieces, Hz
  Index pieces = 1;

  double log_all() const {
    double out = 0.0;
    for (const double one : log_tracks) out += one;
    return out;
  }
  /// A phase and a size a piece.
  double dof() const {
    return 2.0 * static_cast<double>(pieces) * static_cast<double>(columns.size());
  }
};

// The best tracks of some replicates in a band, and their p-value.
struct Tracks {
  std::vector<WavePieces> pieces{};
  std::vector<WaveTrack> track{};
  double log_tracks = 0.0;
  double log_p = 0.0;
};

Band band_of(const WavePieces& pieces, const EffectTerm& term, Hertz rate) {
  return pieces.band(term[kWanderFrom] / rate.value, term[kWanderTo] / rate.value);
}

Tracks tracks_of(const Current& current, const EffectTerm& term, Index count) {
  Tracks out{.pieces = all_pieces(current, count)};
  double gain = 0.0;
  for (const WavePieces& one : out.pieces) {
    const Band in = band_of(one, term, current.subject().rate);
    out.track.push_back(best_track(one, in));
    out.log_tracks += one.log_tracks(in);
    gain += gain_of(one, out.track.back());
  }
  const double dof = 2.0 * static_cast<double>(count) * static_cast<double>(out.pieces.size());
  out.log_p = log_p_value(gain, dof, INFINITY, false, {0.0, out.log_tracks});
  return out;
}

// Precondition: replicates that can be cut, see check_wander().
Tracks best_tracks(const Current& current, const EffectTerm& term) {
  std::optional<Tracks> best;
  for (const Index count : piece_counts(current.subject())) {
    Tracks one = tracks_of(current, term, count);
    if (!best || one.log_p < best->log_p) best = std::move(one);
  }
  return std::move(*best);
}

Columns columns_along(const Current& current, const WavePieces& pieces, const WaveTrack& track) {
  const Eigen::ArrayXd phase = phase_of(current, pieces, track);
  return {{SharedVector(cosine_transform(phase.cos().matrix())),
           SharedVector(cosine_transform(phase.sin().matrix()))},
          {},
          {}};
}

FittedModel fit_with_wander(const EffectTerm& term, const Regression& regression,
                            const JointFit& fit) {
  const Current current = current_of(regression, fit);
  const Tracks best = best_tracks(current, term);
  auto found = std::make_shared<FoundTracks>();
  auto subject = std::make_shared<Subject>(regression.subject());
  const std::size_t count = subject->replicates();
  found->pieces = best.pieces.front().gain.cols();
  found->columns.resize(count);
  for_each_index(count, [&](std::size_t k) {
    found->columns[k] = columns_along(current, best.pieces[k], best.track[k]);
  });
  subject->own_nats.resize(count, 0.0);
  for (std::size_t k = 0; k < count; ++k) {
    const WavePieces& pieces = best.pieces[k];
    for (const Index place : best.track[k])
      found->frequency += pieces.frequency(place) * subject->rate.value /
                          static_cast<double>(found->pieces * static_cast<Index>(count));
    found->log_tracks.push_back(pieces.log_tracks(band_of(pieces, term, subject->rate)));
    subject->own_nats[k] += found->log_tracks[k] + static_cast<double>(found->pieces);
  }
  subject->keep(term, found);
  Regression grown = regression.on(subject).with(term);
  JointFit with = joint_fit(grown, fit.model.noise, {}, Begin::kAnywhere, fit.own_noise);
  return {std::move(grown), std::move(with)};
}

Regressors wander_regressors(const EffectTerm& term, const Subject& subject) {
  const auto* found = subject.found_by<FoundTracks>(term);
  if (found == nullptr) return {std::vector<Columns>(subject.replicates()), {}};
  return in_all(subject, true, {"cosine", "sine"},
                [&](std::size_t k) { return found->columns[k]; });
}

std::string_view wander_fault(const EffectTerm& term) {
  return term[kWanderFrom] < term[kWanderTo] ? "" : "from must lie below to";
}

Result<void> check_wander(const EffectTerm& term, const Subject& subject) {
  if (term[kWanderTo] > 0.5 * subject.rate.value) return too_fast(term, subject);
  if (piece_counts(subject).empty()) return unfit(term, "a single replicate is too short for it");
  return {};
}

// Each replicate lies elsewhere within the band, and swings once.
void simulate_wander(const EffectTerm& term, const SimulatedReplicate& at,
                     Eigen::VectorXd& samples) {
  const double own = uniform_number(at.random) - 0.5;
  const double swing = kTurn * uniform_number(at.random);
  double phase = kTurn * uniform_number(at.random);
  for (Index t = 0; t < samples.size(); ++t) {
    samples(t) += term[kWanderAmplitude] * std::cos(phase);
    const double along = static_cast<double>(t) / static_cast<double>(samples.size());
    const double moved = 0.5 + 0.5 * own + 0.2 * std::sin(kTurn * along + swing);
    const double f = term[kWanderFrom] + moved * (term[kWanderTo] - term[kWanderFrom]);
    phase += kTurn * f / at.beside.rate.value;
  }
}

// The band in which tracks of so many pieces explain most, beside what their number explains by
// chance.
struct BestBand {
  double frequency = 0.0;  // cycles per sample
  double within = 0.0;
  double gain = 0.0;
  double log_tracks = 0.0;
  double tried = 0.0;  // bands
};

BestBand best_band(const std::vector<WavePieces>& pieces, double width) {
  std::vector<Eigen::ArrayXd> through(pieces.size());
  for_each_index(through.size(),
                 [&](std::size_t k) { through[k] = gained_through_middle(pieces[k]); });
  BestBand best;
  double worth = -INFINITY;
  double tried = 0.0;
  const auto shortest = std::min_element(
      pieces.begin(), pieces.end(),
      [](const WavePieces& a, const WavePieces& b) { return a.length < b.length; });
  const double lowest = kFewestWandering / static_cast<double>(shortest->length);
  for (double f = lowest / (1.0 - width); f * (1.0 + width) < 0.5; f *= 1.0 + width, ++tried) {
    BestBand one{.frequency = f, .within = std::max(width * f, 4.0 * shortest->frequency(1))};
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      const Band in = pieces[k].band(f - one.within, f + one.within);
      one.gain += through[k].segment(in.first, in.size()).maxCoeff();
      one.log_tracks += pieces[k].log_tracks(in);
    }
    if (one.gain - one.log_tracks <= worth) continue;
    worth = one.gain - one.log_tracks;
    best = one;
  }
  best.tried = tried;
  return best;
}

// Is the size of the wave the same all the time? That of noise which rings comes and goes. Along
// the track the wave is a constant in noise of variance 1, whose means over stretches scatter by
// chance and by what a track loses between its places.
bool even(const Current& current, const Tracks& tracks) {
  constexpr double kLost = 0.15;
  constexpr double kUneven = 1e-3;
  double chi = 0.0;
  Index dof = 0;
  for (std::size_t k = 0; k < tracks.pieces.size(); ++k) {
    const WavePieces& pieces = tracks.pieces[k];
    const WaveTrack& track = tracks.track[k];
    const Eigen::ArrayXd phase = phase_of(current, pieces, track);
    const Eigen::ArrayXd along = current.weighted[k].array() * phase.cos();
    // As many stretches as show the wave, each by about two standard errors.
    const auto count = static_cast<Index>(std::clamp(0.5 * gain_of(pieces, track), 4.0, 64.0));
    const Index length = along.size() / count;
    const double level = noise_level(current, k, pieces.frequency(track[track.size() / 2]));
    Eigen::ArrayXd size(count);
    for (Index i = 0; i < count; ++i)
      size(i) = along.segment(i * length, length).sum() /
                std::sqrt(0.5 * static_cast<double>(length) / level);
    const double lost = kLost * size.mean();
    chi += (size - size.mean()).square().sum() / (1.0 + lost * lost);
    dof += count - 1;
  }
  return chi_square_test(chi, dof).p_value > kUneven;
}

Suggestions search_wander(const SearchView& view) {
  const Current& current = view.current();
  const Subject& subject = view.subject();
  BestBand best;
  double most = INFINITY;
  double dof = 0.0;
  double tried = 0.0;
  for (const Index count : piece_counts(subject)) {
    const std::vector<WavePieces> pieces = all_pieces(current, count);
    for (const double width : kWidths) {
      const BestBand one = best_band(pieces, width);
      tried += one.tried;
      if (!(one.gain > 0.0)) continue;
      const double all = 2.0 * static_cast<double>(count) * static_cast<double>(pieces.size());
      const double log_p = log_p_value(one.gain, all, INFINITY, false, {0.0, one.log_tracks});
      if (!(log_p < most)) continue;
      most = log_p;
      best = one;
      dof = all;
    }
  }
  if (!(best.frequency > 0.0)) return {};
  const double rate = subject.rate.value;
  const EffectTerm band(wander(), "",
                        {{"from", (best.frequency - best.within) * rate},
                         {"to", (best.frequency + best.within) * rate}});
  const EffectTerm term = rounded(band, 0.0, subject.rate);
  Suggestion out{.cause = "wandering_line",
                 .added = term,
                 .dof = dof,
                 .search = {.log_places = std::log(tried)}};
  // The best of so many tracks gains much by chance: only what is beyond that is worth a fit.
  constexpr double kLikely = -3.0;
  const bool likely = most + out.search.log_places < kLikely && check_wander(term, subject);
  if (likely && even(current, best_tracks(current, term))) out.score_nats = best.gain;
  return {out};
}

// The tracks that were tried are part of the search.
void review_wander(const Current&, TriedTerm& tried) {
  const auto* found = tried.fitted.regression.subject().found_by<FoundTracks>(*tried.term());
  tried.suggestion.dof = found->dof();
  tried.suggestion.search.log_places += found->log_all();
}

// Root mean square over the replicates, less what noise adds.
std::vector<ReportedNumber> wander_numbers(const FittedEffect& effect) {
  const Regression& regression = effect.model.regression;
  const Index first = regression.first(effect.number);
  const Index count = regression.first(effect.number + 1) - first;
  const EffectCoefficients& found = effect.model.fit.effects;
  const double noise = found.covariance.diagonal().segment(first, count).sum();
  const double square = found.value.segment(first, count).squaredNorm();
  const auto replicates = static_cast<double>(effect.subject().replicates());
  const auto* tracks = effect.subject().found_by<FoundTracks>(effect.term());
  return {with_error({"amplitude", std::sqrt(std::max(0.0, square - noise) / replicates),
                      unit_of(effect.term(), effect.subject())},
                     std::sqrt(0.5 * noise) / replicates),
          {"mean_frequency_hz", tracks->frequency, "Hz"}};
}

}  // namespace

const Effect& wander() {
  static const Effect kWander{
      .name = "wander",
      .title = "wandering wave",
      .meaning =
          "Adds a wave whose frequency differs between replicates and moves slowly within "
          "one.",
      .parameters = {{.name = "from",
                      .meaning = "lowest frequency that the wave may take",
                      .unit = "Hz",
                      .required = true,
                      .reported = "from_hz",
                      .rounding = Rounding::kFourDigits},
                     {.name = "to",
                      .meaning = "highest frequency that the wave may take",
                      .unit = "Hz",
                      .required = true,
                      .reported = "to_hz",
                      .rounding = Rounding::kFourDigits},
                     {.name = "amplitude",
                      .meaning = "amplitude of the wave",
                      .reported = "amplitude",
                      .truth = true}},
      .coefficient = "amplitude",
      .causes = {{.id = "wandering_line",
                  .title = "sine wave of changing frequency",
                  .physics = "A fan or a pump whose speed is not controlled, or a building in the "
                             "wind.",
                  .record_next = "the same with fans and pumps off, one after the other, or the "
                                 "speed of the machine beside it",
                  .looks_like = {"line", "resonance"},
                  .family = "wandering_line"}},
      .fault = wander_fault,
      .check = check_wander,
      .regressors = wander_regressors,
      .fit_with = fit_with_wander,
      .simulate = simulate_wander,
      .search = search_wander,
      .review = review_wander,
      .numbers = wander_numbers,
  };
  return kWander;
}

}  // namespace imunoise::effects
