// variance_wander: the noise's power wanders by itself.

#include <algorithm>
#include <cmath>

#include "core/effect/columns.h"
#include "core/effects/reshaped_noise.h"
#include "core/search/search_view.h"

namespace imunoise::effects {

const Effect& variance_wander();

namespace {

enum VarianceWanderParameter : std::size_t { kVarianceWanderTau, kVarianceWanderDeviation };

// What a fit found of it.
struct WanderingPower : Found {
  double deviation = 0.0;  // of the logarithm of the power
};

// Nats that a course of the logarithm of the power gains over one power, were it known: more no
// course that was found gains. The likelihood of the logarithms takes them for normal, and one far
// below the others for less likely than it is.
double gain_if_known(const Eigen::VectorXd& white, const Eigen::ArrayXd& course) {
  const auto n = static_cast<double>(white.size());
  const Eigen::ArrayXd squares = white.array().square();
  const double evened = (squares * (-course).exp()).sum();
  return 0.5 * (n * std::log(squares.sum() / evened) - course.sum());
}

std::shared_ptr<const Subject> of_steady_power(const EffectTerm& term, const Current& current) {
  const auto view =
      PowerView::of(innovations(current.regression, current.fit), current.subject().rate);
  auto found = std::make_shared<WanderingPower>();
  if (!view) {
    auto same = std::make_shared<Subject>(current.subject());
    same->keep(term, std::move(found));
    return same;
  }
  const PowerView wandering = view->with_correlation_time(term[kVarianceWanderTau]);
  found->deviation = wandering.deviation();
  auto out = reshaped(current, [&](const Eigen::VectorXd& white, std::size_t k) {
    const Eigen::ArrayXd course = wandering.course(k, white.size());
    return Reshaping{(-0.5 * course).exp(),
                     std::min(wandering.gain_in(k), gain_if_known(white, course))};
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
  const PowerView* const power = view.power();
  if (power == nullptr) return {};
  // Beside the witness that explains most of it.
  double gain = power->wander_gain();
  double most = 0.0;
  for (const PowerView::Explained& one : view.power_explained()) {
    if (!(one.gain > most)) continue;
    most = one.gain;
    gain = one.left;
  }
  constexpr double kSurely = 3.0;  // nats
  if (gain > kSurely) gain += std::max(0.0, power->normal_gain() - power->wander_gain());
  const Subject& subject = view.subject();
  const double shortest = 2.0 / subject.rate.value;
  // A power that moves within none of the replicates has a time as long as they are, or longer.
  double longest = shortest;
  for (std::size_t k = 0; k < subject.replicates(); ++k)
    longest = std::max(longest, subject.seconds(k));
  const double seconds = power->correlation_time();
  if (!(seconds >= shortest)) gain = 0.0;
  constexpr double kPlaces = 8.0;  // separate correlation times
  return {{.cause = "variance_wander",
           .added =
               EffectTerm(variance_wander(), "", {{"tau", std::clamp(seconds, shortest, longest)}}),
           .score_nats = std::max(0.0, gain),
           .power = true,
           .search = {.log_places = std::log(kPlaces)}}};
}

// The search knows what it gains beside a witness. Whatever it follows may be unrecorded.
void review_variance_wander(const Current& current, TriedTerm& tried) {
  if (worsens_tails(current, tried.fitted)) tried.likelihood_gain = 0.0;
  tried.likelihood_gain = std::min(tried.likelihood_gain, tried.suggestion.score_nats);
  tried.could_be.push_back("modulated_variance");
}

std::vector<ReportedNumber> variance_wander_numbers(const FittedEffect& effect) {
  const auto* const found = effect.subject().found_by<WanderingPower>(effect.term());
  if (found == nullptr) return {};
  return {{"deviation", found->deviation, "1"}};
}

}  // namespace

const Effect& variance_wander() {
  static const Effect kVarianceWander{
      .name = "variance_wander",
      .title = "noise power that wanders",
      .meaning =
          "The logarithm of the noise's power is a Markov process, whose course imunoise "
          "finds in each replicate.",
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
