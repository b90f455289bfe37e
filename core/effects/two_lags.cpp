// two_lags: proportional to another channel behind two first-order lags in a row, such as heat that
// goes through a case and then through the sensor.

#include <algorithm>
#include <array>
#include <cmath>

#include "core/effect/columns.h"
#include "core/effect/filters.h"
#include "core/effects/couplings/couplings.h"
#include "core/search/lagged_witness.h"
#include "core/search/search_view.h"
#include "core/spectrum/cosine_transform.h"
#include "core/support/parallel.h"

namespace imunoise::effects {

const Effect& two_lags();

namespace {

using Index = Eigen::Index;

enum TwoLagsParameter : std::size_t { kTwoLagsFast, kTwoLagsSlow, kTwoLagsCoefficient };

std::string_view two_lags_fault(const EffectTerm& term) {
  return term[kTwoLagsFast] <= term[kTwoLagsSlow] ? "" : "fast must not be more than slow";
}

Eigen::VectorXd behind(const VectorRef& x, double slow, double fast) {
  return lagged(lagged(x, slow), fast);
}

Eigen::VectorXd behind_samples(const EffectTerm& term, const Subject& subject, std::size_t k) {
  return behind(subject.find(term.witness)->samples[k], term[kTwoLagsSlow] * subject.rate.value,
                term[kTwoLagsFast] * subject.rate.value);
}

Regressors two_lags_regressors(const EffectTerm& term, const Subject& subject) {
  return in_all(subject, false, {"coefficient"}, [&](std::size_t k) {
    SharedVector samples = behind_samples(term, subject, k);
    return Columns{{SharedVector(cosine_transform(samples))}, {}, {samples}};
  });
}

void simulate_two_lags(const EffectTerm& term, const SimulatedReplicate& at,
                       Eigen::VectorXd& samples) {
  samples += term[kTwoLagsCoefficient] * behind_samples(term, at.beside, at.replicate);
}

std::string two_lags_unit(const EffectTerm& term, const Subject& subject) {
  return per(std::string(si_symbol(subject.quantity)), unit_of(*subject.find(term.witness)));
}

// The best pair of lags, where it explains clearly more than the best single one.
Suggestion best_pair(const SearchView& view, const SlowView& slow, const Witness& channel) {
  const Subject& subject = view.subject();
  Suggestion out{.cause = coupling_effect(subject.quantity, channel),
                 .added = EffectTerm(two_lags(), channel.name)};
  const LaggedWitness single(slow, subject, channel);
  if (!(single.shortest() < single.longest())) return out;
  const auto best_of = [&](double shortest, const std::function<SlowView::Means(double)>& family) {
    return slow.best_time(shortest, single.longest(), false, family);
  };
  constexpr double kClearly = 3.0;  // nats
  const double alone =
      best_of(single.shortest(), [&](double lag) { return single.late(lag); }).gain;
  if (alone < kClearly) return out;  // what one lag shows nothing of, two do not
  SlowView::Means means;
  for (std::size_t k = 0; k < subject.replicates(); ++k)
    means.push_back(slow.means(channel.samples[k], k));
  constexpr std::array<double, 4> kRatios{1.0, 0.5, 0.25, 0.125};
  double path = 0.0;
  double rows = 0.0;
  double most = alone + kClearly;
  for (const double ratio : kRatios) {
    const double shortest = single.shortest() / ratio;
    if (!(shortest < single.longest())) continue;
    const SlowView::BestTime best = best_of(shortest, [&](double seconds) {
      SlowView::Means late;
      for (std::size_t k = 0; k < means.size(); ++k) {
        const double blocks = seconds / slow.block_seconds(k);
        late.push_back(behind(means[k], blocks, ratio * blocks));
      }
      return late;
    });
    path += best.path;
    ++rows;
    if (!(best.gain > most)) continue;
    most = best.gain;
    out.added = EffectTerm(two_lags(), channel.name,
                           {{"fast", ratio * best.seconds}, {"slow", best.seconds}});
    out.score_nats = best.gain;
    out.information = best.information;
    out.shape_error = best.log_error;
  }
  // Davies' bound of each row of lags, added up.
  if (rows > 0.0) out.search = {.path = path / rows, .log_places = std::log(rows)};
  return out;
}

Suggestions search_two_lags(const SearchView& view) {
  const std::vector<Witness>& witnesses = view.subject().witnesses;
  if (witnesses.empty()) return {};
  const SlowView& slow = view.slow();
  std::vector<std::optional<Suggestion>> each(witnesses.size());
  for_each_index(each.size(),
                 [&](std::size_t w) { each[w] = best_pair(view, slow, witnesses[w]); });
  Suggestions out;
  for (auto& one : each) out.push_back(std::move(*one));
  return out;
}

}  // namespace

const Effect& two_lags() {
  static const Effect kTwoLags{
      .name = "two_lags",
      .title = "coupling behind two lags",
      .meaning = "Adds another channel times a coefficient, behind two first-order lags in a row.",
      .witness = true,
      .parameters = {{.name = "fast",
                      .meaning = "time constant of the faster lag",
                      .unit = "s",
                      .required = true,
                      .reported = "fast_lag_s",
                      .rounding = Rounding::kFourDigits},
                     {.name = "slow",
                      .meaning = "time constant of the slower lag",
                      .unit = "s",
                      .required = true,
                      .reported = "slow_lag_s",
                      .rounding = Rounding::kFourDigits,
                      .error = ShapeError::kLogarithm},
                     {.name = "coefficient",
                      .meaning = "output per unit of the witness",
                      .lower = -1e15,
                      .reported = "coefficient",
                      .truth = true}},
      .coefficient = "coefficient",
      .fault = two_lags_fault,
      .unit = two_lags_unit,
      .regressors = two_lags_regressors,
      .simulate = simulate_two_lags,
      .search = search_two_lags,
  };
  return kTwoLags;
}

}  // namespace imunoise::effects
