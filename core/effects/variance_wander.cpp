// variance_wander: the noise's power wanders by itself.

#include <algorithm>
#include <cmath>

#include "core/effect/columns.h"
#include "core/effects/distributions/wandering_power.h"
#include "core/effects/reshaped_noise.h"
#include "core/search/search_view.h"

namespace imunoise::effects {

const Effect& variance_wander();

namespace {

enum VarianceWanderParameter : std::size_t { kVarianceWanderTau, kVarianceWanderDeviation };

struct FoundWander : Found {
  double deviation = 0.0;  // of the logarithm of the power,
  double error = 0.0;      // and the standard error of its logarithm
};

std::shared_ptr<const Subject> of_steady_power(const EffectTerm& term, const Current& current) {
  const auto powers = WanderingPower::of(innovations(current.regression, current.fit),
                                         current.subject().rate, term[kVarianceWanderTau]);
  auto found = std::make_shared<FoundWander>();
  found->deviation = powers.deviation();
  found->error = powers.deviation_error();
  auto out = reshaped(current, [&](const Eigen::VectorXd& white, std::size_t) {
    WanderingPower::Evened even = powers.evened(white);
    return Reshaping{std::move(even.factor), even.nats};
  });
  out->keep(term, std::move(found));
  return out;
}

Result<void> check_variance_wander(const EffectTerm& term, const Subject& subject) {
  if (term[kVarianceWanderTau] * subject.rate.value < 1.0)
    return unfit(term, "tau is shorter than a sample");
  return {};
}

void simulate_variance_wander(const EffectTerm& term, const SimulatedReplicate& at,
                              Eigen::VectorXd& samples) {
  const double phi = std::exp(-1.0 / (term[kVarianceWanderTau] * at.beside.rate.value));
  double course = at.random.normal();
  for (double& x : samples) {
    x *= std::exp(0.5 * term[kVarianceWanderDeviation] * course);
    course = phi * course + std::sqrt(1.0 - phi * phi) * at.random.normal();
  }
}

Suggestions search_variance_wander(const SearchView& view) {
  const Innovations& all = view.unmodulated();
  const Hertz rate = view.subject().rate;
  WanderingPower powers;
  if (const auto memory = memory_of_power(all))
    powers = WanderingPower::from(all, rate, memory->tau / rate.value);
  const bool likely =
      powers.gain() > 0.0 && !will_worsen_tails(tails_of(all), powers.kurtosis_ratio());
  constexpr double kPlaces = 8.0;  // separate correlation times
  const double shortest = 1.0 / rate.value;
  return {
      {.cause = "variance_wander",
       .added = EffectTerm(variance_wander(), "", {{"tau", std::max(shortest, powers.tau_s())}}),
       .score_nats = likely ? powers.gain() : 0.0,
       .power = true,
       .search = {.log_places = std::log(kPlaces)}}};
}

// Whatever it follows may be unrecorded.
void review_variance_wander(const Current& current, TriedTerm& tried) {
  if (worsens_tails(current, tried.fitted)) tried.likelihood_gain = 0.0;
  tried.likelihood_gain = std::min(tried.likelihood_gain, tried.suggestion.score_nats);
  tried.could_be.push_back("modulated_variance");
  // What lasts for a few samples only.
  constexpr double kBrief = 16.0;     // samples, over which bursts are told
  constexpr double kVeryBrief = 4.0;  // samples, over which whitening spreads each
  const double tau = (*tried.term())[kVarianceWanderTau] * current.subject().rate.value;
  if (tau < kBrief) tried.could_be.push_back("bursts");
  if (tau < kVeryBrief) tried.could_be.push_back("heavy_tails");
}

std::vector<ReportedNumber> variance_wander_numbers(const FittedEffect& effect) {
  const auto* const found = effect.subject().found_by<FoundWander>(effect.term());
  if (found == nullptr) return {};
  const ReportedNumber deviation{"deviation", found->deviation, "1"};
  return {std::isfinite(found->error) ? with_log_error(deviation, found->error) : deviation};
}

}  // namespace

const Effect& variance_wander() {
  static const Effect kVarianceWander{
      .name = "variance_wander",
      .title = "noise power that wanders",
      .meaning =
          "The logarithm of the noise's power is a Markov process, which imunoise follows in "
          "each replicate.",
      .parameters = {{.name = "tau",
                      .meaning = "correlation time of the power",
                      .unit = "s",
                      .required = true,
                      .reported = "tau_s",
                      .rounding = Rounding::kFourDigits},
                     {.name = "deviation",
                      .meaning = "standard deviation of the logarithm of the power",
                      .unit = "1",
                      .reported = "deviation",
                      .truth = true}},
      .causes = {{.id = "variance_wander",
                  .title = "noise power that wanders",
                  .physics =
                      "The noise grows and fades by itself: bursts of interference, traffic, "
                      "a fan that starts, or something unrecorded that changes the noise.",
                  .record_next = "the same in a quiet place, with everything that could disturb "
                                 "the sensor recorded",
                  .looks_like = {"modulated_variance", "replicate_change", "outliers"},
                  .family = "variance_wander"}},
      .check = check_variance_wander,
      .cleaned = of_steady_power,
      .simulate = simulate_variance_wander,
      .search = search_variance_wander,
      .review = review_variance_wander,
      .numbers = variance_wander_numbers,
  };
  return kVarianceWander;
}

}  // namespace imunoise::effects
