#include <algorithm>
#include <cmath>

#include "core/diagnosis/catalogue.h"
#include "core/diagnosis/scan.h"
#include "core/diagnosis/witness_lags.h"
#include "core/spectrum/cosine_transform.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

// Sums over all replicates, by the place in the transform of the first: products of the whitened
// witness with what is left, and its squares. Cumulated from low frequencies up.
struct Cumulated {
  Eigen::ArrayXd product;
  Eigen::ArrayXd square;
  double gain(Index from, Index to) const {
    const double p = product(to) - product(from);
    const double s = square(to) - square(from);
    return s > 0.0 ? 0.5 * p * p / s : 0.0;
  }
};

// At the octaves of frequency: entry i holds all below 2^i/2T. `regressor`: one transform a
// replicate.
Cumulated cumulated(const Current& current, const std::vector<SharedVector>& regressor) {
  const auto octaves =
      static_cast<Index>(std::ceil(std::log2(static_cast<double>(current.subject().length(0)))));
  Cumulated out{Eigen::ArrayXd::Zero(octaves + 1), Eigen::ArrayXd::Zero(octaves + 1)};
  for (std::size_t k = 0; k < current.cosines.size(); ++k) {
    const Eigen::ArrayXd weighted = regressor[k].array() / current.spectrum[k];
    Index begin = 0;
    double product = 0.0;
    double square = 0.0;
    for (Index i = 0; i <= octaves; ++i) {
      const Index end = std::min<Index>(weighted.size(), (Index{1} << i) - 1);
      product += weighted.segment(begin, end - begin)
                     .matrix()
                     .dot(current.cosines[k].segment(begin, end - begin));
      square += weighted.segment(begin, end - begin)
                    .matrix()
                    .dot(regressor[k].segment(begin, end - begin));
      out.product(i) += product;
      out.square(i) += square;
      begin = end;
    }
  }
  return out;
}

// Parts of the frequencies are tried from here on; below there is too little to tell.
constexpr Index kFirstOctave = 4;

double edge_of(const Current& current, Index octave) {
  return std::exp2(static_cast<double>(octave)) * 0.5 / current.subject().seconds(0);
}

void add_static(const Current& current, const Witness& witness, Suggestions& out) {
  const Cumulated sums = cumulated(current, witness.cosines);
  const Index last = sums.product.size() - 1;
  const EffectTerm whole{.kind = EffectKind::kWitness, .witness = witness.name};
  out.push_back({.effect = coupling_effect(current.subject().quantity, witness),
                 .added = whole,
                 .score_nats = sums.gain(0, last),
                 .information = sums.square(last)});
  if (!may_share_motion(current.subject().quantity, witness)) return;
  // The slow or the fast part alone: what both sensors see, not what one leaks into the other.
  Suggestion slow{.effect = "tilt", .added = whole};
  Suggestion fast{.effect = "common_vibration", .added = whole};
  slow.search.log_places = fast.search.log_places =
      std::log(static_cast<double>(last - kFirstOctave));
  for (Index i = kFirstOctave; i < last; ++i) {
    const double edge = edge_of(current, i);
    if (const double gain = sums.gain(0, i); gain > slow.score_nats) {
      slow.score_nats = gain;
      std::get<EffectTerm>(slow.added).to = edge;
    }
    if (const double gain = sums.gain(i, last); gain > fast.score_nats) {
      fast.score_nats = gain;
      std::get<EffectTerm>(fast.added).from = edge;
    }
  }
  // A bench tilts over minutes; what is faster is vibration.
  constexpr double kFastestTilt = 0.1;  // Hz
  if (std::get<EffectTerm>(slow.added).to > kFastestTilt) slow.effect = fast.effect;
  if (slow.score_nats > 0.0) out.push_back(std::move(slow));
  if (fast.score_nats > 0.0) out.push_back(std::move(fast));
}

// A gyroscope on a bench that rocks feels how fast the accelerometers' view of gravity turns: at
// the frequencies where that view is more than the accelerometers' own noise, which are the low
// ones.
void add_rocking(const Current& current, const Witness& witness, Suggestions& out) {
  const Subject& subject = current.subject();
  if (!feels_rocking(subject.quantity, witness)) return;
  std::vector<SharedVector> turning;
  for (const SharedVector& x : witness.samples)
    turning.emplace_back(cosine_transform(rate_of_change(x, subject.rate.value)));
  const Cumulated sums = cumulated(current, turning);
  const Index last = sums.product.size() - 1;
  const EffectTerm rate{.kind = EffectKind::kWitness, .witness = witness.name, .derivative = true};
  Suggestion best{.effect = "tilt",
                  .added = rate,
                  .score_nats = sums.gain(0, last),
                  .search = {.log_places = std::log(static_cast<double>(last - kFirstOctave + 1))},
                  .information = sums.square(last)};
  for (Index i = kFirstOctave; i < last; ++i) {
    const double gain = sums.gain(0, i);
    if (!(gain > best.score_nats)) continue;
    best.score_nats = gain;
    best.information = sums.square(i);
    std::get<EffectTerm>(best.added).to = edge_of(current, i);
  }
  if (best.score_nats > 0.0) out.push_back(std::move(best));
}

void add_lagged(const Current& current, const SlowView& view, const Witness& witness,
                Suggestions& out) {
  const Subject& subject = current.subject();
  const std::string_view effect = coupling_effect(subject.quantity, witness);
  const LaggedWitness behind(view, subject, witness);
  if (behind.shortest() < behind.longest()) {
    const auto best_of = [&](const std::function<SlowView::Means(double)>& family) {
      return view.best_time(behind.shortest(), behind.longest(), false, family);
    };
    const SlowView::BestTime best = best_of([&](double lag) { return behind.late(lag); });
    const SlowView::BestTime backwards = best_of([&](double lag) { return behind.early(lag); });
    constexpr double kClearly = 3.0;  // nats
    if (best.gain > 0.0) {
      out.push_back({.effect = effect,
                     .added = EffectTerm{.kind = EffectKind::kWitness,
                                         .witness = witness.name,
                                         .lag = best.seconds},
                     .score_nats = best.gain,
                     .search = {best.path, 0.0},
                     .information = best.information,
                     .shape_error = best.log_error,
                     .backwards = backwards.gain > best.gain + kClearly});
    }
  }

  std::vector<Eigen::VectorXd> squares;
  for (std::size_t k = 0; k < subject.replicates(); ++k)
    squares.push_back(view.means(witness.samples[k].array().square().matrix(), k));
  const Eigen::VectorXd squared = view.whitened(squares);
  out.push_back(
      {.effect = effect,
       .added =
           EffectTerm{.kind = EffectKind::kWitness, .witness = witness.name, .quadratic = true},
       .score_nats = view.gain(squared, false),
       .information = squared.squaredNorm()});
}

}  // namespace

Suggestions scan_witnesses(const Current& current) {
  const Subject& subject = current.subject();
  if (subject.witnesses.empty()) return {};
  const SlowView view(current);
  const Innovations white = innovations(current.regression, current.fit);
  std::vector<Suggestions> each(subject.witnesses.size());
  for_each_index(each.size(), [&](std::size_t w) {
    const Witness& witness = subject.witnesses[w];
    add_static(current, witness, each[w]);
    add_lagged(current, view, witness, each[w]);
    add_rocking(current, witness, each[w]);
    each[w].push_back({.effect = "modulated_variance",
                       .added = EffectTerm{.kind = EffectKind::kModulated, .witness = witness.name},
                       .score_nats = modulation_by(witness, white).log_likelihood});
  });
  Suggestions out;
  for (const Suggestions& some : each) out.insert(out.end(), some.begin(), some.end());
  return out;
}

}  // namespace imunoise
