// Noise whose power follows a channel: replicates recorded at other temperatures belong to it.

#include <gtest/gtest.h>

#include <cmath>

#include "core/diagnosis/candidates.h"
#include "core/diagnosis/views/misfit.h"
#include "core/effects/known_effects.h"
#include "core/regression/current.h"
#include "core/support/random.h"
#include "tests/core/diagnosis/subject_of.h"
#include "tests/support/figures_alone.h"

namespace imunoise {
namespace {

constexpr double kPerKelvin = 0.03;  // growth of the variance

// Swings of 4 K about a temperature that differs by up to 9 K between replicates.
double kelvins(std::size_t k, double s) {
  static constexpr double kMeans[] = {297.0, 303.0, 300.0, 306.0};
  return kMeans[k] + 4.0 * wave(0.011, s);
}

TEST(Modulated, ExplainsReplicatesOfOtherTemperatures) {
  constexpr std::uint64_t kSeed = 31;
  const MadeSubject made{.model = "WN(sigma2=1)", .samples = 16'384, .seed = kSeed};
  const std::shared_ptr<const Subject> plain = subject_of(made);
  MadeSubject warm = made;
  warm.model = "WN(sigma2=1e-12)";
  warm.temperature = kelvins;
  warm.added = [&](std::size_t k, double s) {
    const auto t = static_cast<Eigen::Index>(std::lround(s * plain->rate.value));
    return plain->samples[k](t) * std::exp(0.5 * kPerKelvin * (kelvins(k, s) - 300.0));
  };
  const FittedModel base = fitted(subject_of(warm), "WN");
  const FittedModel with = fit_with(current_of(base.regression, base.fit),
                                    EffectTerm(effect_named("modulated"), "temperature"));
  const Modulation& found = with.fit.modulation.front();
  const double slope = found.slope / found.deviation;
  EXPECT_NEAR(slope, kPerKelvin, 5.0 * found.error / found.deviation);
  // Replicates differ by 18 % in power; afterwards by no more than chance, √(2/16384) = 1.1 %.
  for (const ReplicatePower& one : misfit_of(with).powers) EXPECT_NEAR(one.power, 1.0, 0.045);
}

// In replicate 3, the change lies where it is warm: what one of the two explains is not the
// other's. Bound: four standard errors.
TEST(Modulated, AndAChangeOfPowerKeepWhatIsTheirs) {
  constexpr double kRatio = 2.5;
  constexpr double kSlope = 0.05;  // per kelvin
  const auto celsius = [](std::size_t, double s) { return 25.0 + 5.0 * wave(0.006, s); };
  const auto loud = [](std::size_t k, double s) { return k == 2 && s > 20.0 && s < 80.0; };
  RandomStream random(37);
  const auto subject = subject_of({.model = "WN(sigma2=1e-12)",
                                   .samples = 16'384,
                                   .seed = 38,
                                   .added =
                                       [&](std::size_t k, double s) {
                                         const double variance =
                                             std::exp(kSlope * (celsius(k, s) - 25.0));
                                         const double more = loud(k, s) ? kRatio : 1.0;
                                         return std::sqrt(variance * more) * random.normal();
                                       },
                                   .temperature = celsius});
  const std::string change = "power_change(replicate=3, from=20, to=80)";
  const std::string follows = "modulated(temperature)";
  const auto expect_both = [&](const FittedModel& found) {
    for (std::size_t i = 0; i < 2; ++i) {
      const FittedEffect effect{found, i};
      const ReportedNumber number = fitted_numbers(effect).at(0);
      if (number.name == "ratio") {
        EXPECT_NEAR(std::log(number.value), std::log(kRatio), 4.0 * 0.03) << print(effect.term());
      } else {
        const Modulation& modulation = found.fit.modulation.front();
        EXPECT_NEAR(number.value, kSlope, 4.0 * modulation.error / modulation.deviation);
      }
    }
  };
  expect_both(fitted(subject, "WN + " + follows + " + " + change));
  expect_both(fitted(subject, "WN + " + change + " + " + follows));
  // As a ladder adds one to the other.
  for (const auto& [first, second] : {std::pair{change, follows}, std::pair{follows, change}}) {
    const FittedModel one = fitted(subject, "WN + " + first);
    const Current current = current_of(one.regression, one.fit);
    const EffectTerm next = parse_full_model("WN + " + second, subject->rate)->effects.at(0);
    const std::string_view cause = next.effect->causes.front().id;
    const Suggestions with{{.cause = cause, .added = next, .score_nats = 1000.0}};
    expect_both(try_all(current, with).at(0).fitted);
  }
}

// A course as slow as this could be power that wanders by itself, which bursts explain, too.
// Against that alone, this seed has 40 nats left.
TEST(Modulated, ComesBeforeWhatExplainsLessOfASlowCourse) {
  FIGURES_ALONE();
  constexpr std::uint64_t kSeed = 36;
  constexpr double kPeriods[] = {700.0, 500.0, 900.0, 650.0};  // s; a replicate has 655
  constexpr double kSwings[] = {8.0, -5.0, 10.0, 3.0};         // K
  MadeSubject made{.model = "WN(sigma2=1)", .samples = 32'768, .seed = kSeed};
  const std::shared_ptr<const Subject> plain = subject_of(made);
  made.model = "WN(sigma2=1e-12)";
  made.temperature = [&](std::size_t k, double s) {
    return 300.0 + kSwings[k] * wave(1.0 / kPeriods[k], s);
  };
  made.added = [&](std::size_t k, double s) {
    const auto t = static_cast<Eigen::Index>(std::lround(s * plain->rate.value));
    return plain->samples[k](t) * std::exp(0.02 * (made.temperature(k, s) - 300.0));
  };
  const Diagnosis found = diagnose(fitted(subject_of(made), "WN"));
  ASSERT_TRUE(found.worth_adding);
  EXPECT_EQ(found.effects.front().tried.cause, "modulated_variance");
  EXPECT_EQ(found.verdict, DiagnosisVerdict::kFound);
}

}  // namespace
}  // namespace imunoise
