// bursts: for some time, again and again, the noise is larger.

#include <algorithm>
#include <cmath>

#include "core/effect/columns.h"
#include "core/effects/distributions/two_powers.h"
#include "core/effects/draws.h"
#include "core/effects/reshaped_noise.h"
#include "core/search/search_view.h"

namespace imunoise::effects {

const Effect& bursts();

namespace {

enum BurstsParameter : std::size_t { kBurstsLength, kBurstsEvery, kBurstsRatio };

struct FoundBursts : Found {
  double ratio = 1.0;
};

std::string_view bursts_fault(const EffectTerm& term) {
  return term[kBurstsLength] < term[kBurstsEvery] ? "" : "length must lie below every";
}

std::shared_ptr<const Subject> without_bursts(const EffectTerm& term, const Current& current) {
  const TwoPowers powers =
      TwoPowers::of(innovations(current.regression, current.fit), current.subject().rate,
                    BurstTimes{term[kBurstsLength], term[kBurstsEvery]});
  auto found = std::make_shared<FoundBursts>();
  found->ratio = powers.ratio();
  auto out = reshaped(current, [&](const Eigen::VectorXd& white, std::size_t k) {
    return Reshaping{powers.factor(k, white), powers.gain_in(k)};
  });
  out->keep(term, std::move(found));
  return out;
}

void simulate_bursts(const EffectTerm& term, const SimulatedReplicate& at,
                     Eigen::VectorXd& samples) {
  const double rate = at.beside.rate.value;
  const double leave[2] = {1.0 / ((term[kBurstsEvery] - term[kBurstsLength]) * rate),
                           1.0 / (term[kBurstsLength] * rate)};
  std::size_t loud = 0;
  for (double& x : samples) {
    if (uniform_number(at.random) < leave[loud]) loud = 1 - loud;
    if (loud == 1) x *= std::sqrt(term[kBurstsRatio]);
  }
}

Suggestions search_bursts(const SearchView& view) {
  const Innovations& all = view.unmodulated();
  TwoPowers powers;
  if (memory_of_power(all)) powers = TwoPowers::of(all, view.subject().rate);
  const BurstTimes times = powers.times();
  constexpr double kLeastRatio = 1.05;
  const bool likely = powers.gain() > 0.0 && powers.ratio() > kLeastRatio &&
                      !will_worsen_tails(tails_of(all), powers.kurtosis_ratio());
  return {
      {.cause = "bursts",
       .added = EffectTerm(bursts(), "", {{"length", times.length_s}, {"every", times.every_s}}),
       .score_nats = likely ? powers.gain() : 0.0,
       .dof = 3.0}};
}

// A few bursts may be the highest of a power that wanders.
void review_bursts(const Current& current, TriedTerm& tried) {
  if (worsens_tails(current, tried.fitted)) tried.likelihood_gain = 0.0;
  tried.likelihood_gain = std::min(tried.likelihood_gain, tried.suggestion.score_nats);
  constexpr double kMany = 20.0;
  double seconds = 0.0;
  for (std::size_t k = 0; k < current.subject().replicates(); ++k)
    seconds += current.subject().seconds(k);
  if (seconds < kMany * (*tried.term())[kBurstsEvery]) tried.could_be.push_back("variance_wander");
}

std::vector<ReportedNumber> bursts_numbers(const FittedEffect& effect) {
  const auto* const found = effect.subject().found_by<FoundBursts>(effect.term());
  if (found == nullptr) return {};
  return {{"ratio", found->ratio, "1"}};
}

}  // namespace

const Effect& bursts() {
  static const Effect kBursts{
      .name = "bursts",
      .title = "bursts of noise",
      .meaning = "The noise switches between two powers at random times, which imunoise finds.",
      .parameters = {{.name = "length",
                      .meaning = "mean length of a burst",
                      .unit = "s",
                      .required = true,
                      .reported = "length_s",
                      .rounding = Rounding::kFourDigits},
                     {.name = "every",
                      .meaning = "mean time from one burst to the next",
                      .unit = "s",
                      .required = true,
                      .reported = "every_s",
                      .rounding = Rounding::kFourDigits},
                     {.name = "ratio",
                      .meaning = "power in a burst over that between bursts",
                      .unit = "1",
                      .reported = "ratio",
                      .truth = true}},
      .causes = {{.id = "bursts",
                  .title = "bursts of noise",
                  .physics = "Something disturbs the sensor for a while, again and again: "
                             "interference, a compressor, traffic.",
                  .record_next = "the same in a quiet place, with everything that switches on and "
                                 "off recorded",
                  .looks_like = {"variance_wander", "heavy_tails", "outliers"},
                  .family = "bursts"}},
      .fault = bursts_fault,
      .cleaned = without_bursts,
      .simulate = simulate_bursts,
      .search = search_bursts,
      .review = review_bursts,
      .numbers = bursts_numbers,
  };
  return kBursts;
}

}  // namespace imunoise::effects
