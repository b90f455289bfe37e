// witness: proportional to another channel, as it is, filtered, or behind a lag.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/effect/columns.h"
#include "core/effect/filters.h"
#include "core/effects/couplings.h"
#include "core/search/band_gains.h"
#include "core/search/lagged_witness.h"
#include "core/search/search_view.h"
#include "core/spectrum/cosine_transform.h"
#include "core/support/parallel.h"

namespace imunoise::effects {

const Effect& witness();

namespace {

using Index = Eigen::Index;

enum WitnessParameter : std::size_t {
  kWitnessLag,
  kWitnessFrom,
  kWitnessTo,
  kWitnessOctaves,
  kWitnessQuadratic,
  kWitnessVertex,
  kWitnessDerivative,
  kWitnessOwn,
  kWitnessCoefficient,
};

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

// What was taken off a replicate of a channel; 0 where nothing was.
double level(const Witness& channel, std::size_t k) {
  return channel.levels.empty() ? 0.0 : channel.levels[k];
}

// Over the replicates.
double mean_level(const Witness& channel) {
  if (channel.levels.empty()) return 0.0;
  return std::accumulate(channel.levels.begin(), channel.levels.end(), 0.0) /
         static_cast<double>(channel.levels.size());
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

Regressors witness_regressors(const EffectTerm& term, const Subject& subject) {
  const Witness& channel = *subject.find(term.witness);
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
      witness_columns(term, *at.beside.find(term.witness), at.replicate, at.beside.rate.value);
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

// A coefficient an octave takes the place of one for all, where it is clearly better.
void take_octaves(const BandGains& gains, Suggestion& one) {
  constexpr double kClearly = 3.0;  // nats
  const BandGains::Octaves best = gains.best_octaves();
  const double now = log_p_value(one.score_nats, one.dof, INFINITY, false, one.search);
  if (!(best.log_p < now - kClearly)) return;
  auto& term = std::get<EffectTerm>(one.added);
  term.set("from", 0.0);
  term.set("to", gains.hertz(best.to));
  term.set("octaves", static_cast<double>(best.count));
  one.score_nats = best.gain;
  one.dof = static_cast<double>(best.count);
  one.search = best.search;
}

void add_static(const Current& current, const Witness& channel, Suggestions& out) {
  const BandGains gains(current, channel.cosines);
  const Index last = gains.end();
  const EffectTerm whole(witness(), channel.name);
  out.push_back({.cause = coupling_effect(current.subject().quantity, channel),
                 .added = whole,
                 .score_nats = gains.gain(0, last),
                 .information = gains.information(0, last),
                 .coupling = MotionCoupling::kWhole});
  if (!may_share_motion(current.subject().quantity, channel)) return;
  // The slow or the fast part alone: what both sensors see, not what one leaks into the other.
  Suggestion slow{.cause = "tilt", .added = whole, .coupling = MotionCoupling::kBand};
  Suggestion fast{.cause = "common_vibration", .added = whole, .coupling = MotionCoupling::kBand};
  slow.search.log_places = fast.search.log_places =
      std::log(static_cast<double>(last - BandGains::kFirst));
  for (Index i = BandGains::kFirst; i < last; ++i) {
    const double edge = gains.hertz(i);
    if (const double gain = gains.gain(0, i); gain > slow.score_nats) {
      slow.score_nats = gain;
      std::get<EffectTerm>(slow.added).set("to", edge);
    }
    if (const double gain = gains.gain(i, last); gain > fast.score_nats) {
      fast.score_nats = gain;
      std::get<EffectTerm>(fast.added).set("from", edge);
    }
  }
  take_octaves(gains, slow.score_nats > fast.score_nats ? slow : fast);
  // A bench tilts over minutes; what is faster is vibration.
  constexpr double kFastestTilt = 0.1;  // Hz
  for (Suggestion* const one : {&slow, &fast}) {
    const double to = std::get<EffectTerm>(one->added)[kWitnessTo];
    one->cause = to > kFastestTilt ? "common_vibration" : "tilt";
  }
  out.push_back(std::move(slow));
  out.push_back(std::move(fast));
}

// A gyroscope on a bench that rocks feels how fast the accelerometers' view of gravity turns: at
// the frequencies where that view is more than the accelerometers' own noise and what else
// accelerates them.
void add_rocking(const Current& current, const Witness& channel, Suggestions& out) {
  const Subject& subject = current.subject();
  if (!feels_rocking(subject.quantity, channel)) return;
  std::vector<SharedVector> turning;
  for (const SharedVector& x : channel.samples)
    turning.emplace_back(cosine_transform(rate_of_change(x, subject.rate.value)));
  const BandGains gains(current, turning);
  const Index last = gains.end();
  const EffectTerm rate(witness(), channel.name, {{"derivative", 1.0}});
  Suggestion best{.cause = "tilt", .added = rate, .coupling = MotionCoupling::kTurning};
  Index tried = 0;
  for (Index from = 0; from < last; from = from == 0 ? BandGains::kFirst : from + 1) {
    for (Index to = std::max(from + 1, BandGains::kFirst); to <= last; ++to, ++tried) {
      const double gain = gains.gain(from, to);
      if (tried > 0 && !(gain > best.score_nats)) continue;
      best.score_nats = gain;
      best.information = gains.information(from, to);
      EffectTerm band = rate;
      if (from > 0) band.set("from", gains.hertz(from));
      if (to < last) band.set("to", gains.hertz(to));
      best.added = std::move(band);
    }
  }
  best.search.log_places = std::log(static_cast<double>(tried));
  take_octaves(gains, best);
  out.push_back(std::move(best));
}

void add_lagged(const Current& current, const SlowView& view, const Witness& channel,
                Suggestions& out) {
  const Subject& subject = current.subject();
  const std::string_view cause = coupling_effect(subject.quantity, channel);
  const LaggedWitness behind(view, subject, channel);
  if (behind.shortest() < behind.longest()) {
    const auto best_of = [&](const std::function<SlowView::Means(double)>& family) {
      return view.best_time(behind.shortest(), behind.longest(), false, family);
    };
    const SlowView::BestTime best = best_of([&](double lag) { return behind.late(lag); });
    const SlowView::BestTime backwards = best_of([&](double lag) { return behind.early(lag); });
    constexpr double kClearly = 3.0;  // nats
    out.push_back({.cause = cause,
                   .added = EffectTerm(witness(), channel.name, {{"lag", best.seconds}}),
                   .score_nats = best.gain,
                   .search = {best.path, 0.0},
                   .information = best.information,
                   .shape_error = best.log_error,
                   .backwards = backwards.gain > best.gain + kClearly});
  }
}

// A parabola: its vertex is where a straight line beside the square puts it. A line alone may
// explain most of it, so that it is offered only where it explains clearly more.
void add_parabola(const Current& current, const SlowView& view, const Witness& channel,
                  Suggestions& out) {
  const Subject& subject = current.subject();
  const double middle = mean_level(channel);
  SlowView::Means straight;
  SlowView::Means squares;
  for (std::size_t k = 0; k < subject.replicates(); ++k) {
    const Eigen::ArrayXd x = channel.samples[k].array() + (level(channel, k) - middle);
    straight.push_back(view.means(channel.samples[k], k));
    squares.push_back(view.means(x.square().matrix(), k));
  }
  const Eigen::VectorXd line = view.whitened(straight);
  const SlowView::Two both = view.two(line, view.whitened(squares));
  constexpr double kClearly = 6.0;  // nats: chance gains them once in 2,000
  const bool curved = both.gain > view.gain(line, false) + kClearly;
  EffectTerm term(witness(), channel.name, {{"quadratic", 1.0}});
  // a (x - v)² = a x² - 2 a v x + ...
  if (curved) term.set("vertex", middle - 0.5 * both.ratio);
  out.push_back({.cause = coupling_effect(subject.quantity, channel),
                 .added = std::move(term),
                 .score_nats = curved ? both.gain : 0.0,
                 .dof = 2.0,
                 .information = both.information,
                 .shape_error = curved ? 0.5 * both.ratio_error : 0.0});
}

Suggestions search_witness(const SearchView& view) {
  const Subject& subject = view.subject();
  if (subject.witnesses.empty()) return {};
  const SlowView& slow = view.slow();
  std::vector<Suggestions> each(subject.witnesses.size());
  for_each_index(each.size(), [&](std::size_t w) {
    const Witness& channel = subject.witnesses[w];
    add_static(view.current(), channel, each[w]);
    add_lagged(view.current(), slow, channel, each[w]);
    add_parabola(view.current(), slow, channel, each[w]);
    add_rocking(view.current(), channel, each[w]);
  });
  Suggestions out;
  for (const Suggestions& some : each) out.insert(out.end(), some.begin(), some.end());
  return out;
}

// A vertex has the witness's unit.
void add_vertex(const TriedTerm& tried, std::vector<ReportedNumber>& first,
                std::vector<ReportedNumber>&) {
  const EffectTerm& term = *tried.term();
  if (!term.given(kWitnessVertex)) return;
  const Witness& channel = *tried.fitted.regression.subject().find(term.witness);
  first.push_back(
      with_error({"vertex", term[kWitnessVertex], unit_of(channel)}, tried.suggestion.shape_error));
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
      .more_numbers = add_vertex,
  };
  return kWitness;
}

}  // namespace imunoise::effects
