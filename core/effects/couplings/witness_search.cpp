// Where a coupling to another channel would explain most.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/effect/filters.h"
#include "core/effects/couplings/couplings.h"
#include "core/effects/couplings/witness.h"
#include "core/search/band_gains.h"
#include "core/search/lagged_witness.h"
#include "core/search/noisy_witness.h"
#include "core/search/search_view.h"
#include "core/spectrum/cosine_transform.h"
#include "core/support/parallel.h"

namespace imunoise::effects {
namespace {

using Index = Eigen::Index;

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

// A bench tilts over minutes; what is faster is vibration.
std::string_view motion_up_to(double hertz) {
  constexpr double kFastestTilt = 0.1;  // Hz
  return hertz > kFastestTilt ? "common_vibration" : "tilt";
}

// The witness less noise of its own, where that explains clearly more than the whole of it.
void add_noisy(const Current& current, const Witness& channel, Suggestions& out) {
  constexpr double kClearly = 6.0;  // nats: chance gains them once in 2,000
  const Subject& subject = current.subject();
  const double whole = out.back().score_nats;
  const NoisyWitness best = noisy_witness(current, channel.cosines);
  const bool helps = best.log_error > 0.0 && best.gain > whole + kClearly;
  Suggestion one{.cause = coupling_effect(subject.quantity, channel),
                 .added = EffectTerm(witness(), channel.name),
                 .dof = 2.0,
                 .coupling = MotionCoupling::kWhole};
  if (helps) {
    std::get<EffectTerm>(one.added).set("noise", std::sqrt(best.variance / subject.rate.value));
    one.score_nats = best.gain;
    one.information = best.information;
    one.shape_error = 0.5 * best.log_error;
  }
  if (may_share_motion(subject.quantity, channel)) {
    one.cause = motion_up_to(best.to * subject.rate.value);
    one.coupling = MotionCoupling::kBand;
  }
  out.push_back(std::move(one));
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
  add_noisy(current, channel, out);
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
  for (Suggestion* const one : {&slow, &fast})
    one->cause = motion_up_to(std::get<EffectTerm>(one->added)[kWitnessTo]);
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

}  // namespace

double level(const Witness& channel, std::size_t replicate) {
  return channel.levels.empty() ? 0.0 : channel.levels[replicate];
}

double mean_level(const Witness& channel) {
  if (channel.levels.empty()) return 0.0;
  return std::accumulate(channel.levels.begin(), channel.levels.end(), 0.0) /
         static_cast<double>(channel.levels.size());
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

}  // namespace imunoise::effects
