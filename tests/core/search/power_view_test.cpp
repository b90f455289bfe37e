// Power that wanders by itself explains what unrelated slow courses seem to.

#include "core/search/power_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "core/diagnosis/diagnose.h"
#include "core/effects/known_effects.h"
#include "core/process/process.h"
#include "core/search/search_view.h"
#include "tests/core/diagnosis/subject_of.h"

namespace imunoise {
namespace {

constexpr Hertz kPowerRate{50.0};
constexpr std::size_t kPowerSamples = 8192;
constexpr std::uint32_t kPowerReplicates = 4;

// A standard Markov process of 20 s.
std::vector<double> slow_course(std::uint64_t seed, std::uint32_t replicate) {
  const double phi = std::exp(-1.0 / (20.0 * kPowerRate.value));
  const Model markov{{Term(Process(Ar1{1.0 - phi * phi, phi}))}};
  return simulate(markov, kPowerSamples, seed, replicate);
}

VarianceCourse courses(std::uint64_t seed) {
  VarianceCourse out;
  for (std::uint32_t k = 0; k < kPowerReplicates; ++k) {
    const std::vector<double> x = slow_course(seed, k);
    out.samples.emplace_back(Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()))));
  }
  return out;
}

// White noise whose log-variance is `strength` times a course.
Innovations noise_of(const VarianceCourse& course, double strength, std::uint64_t seed) {
  Innovations out;
  const Model white{{Term(Process(WhiteNoise{1.0}))}};
  for (std::uint32_t k = 0; k < kPowerReplicates; ++k) {
    const std::vector<double> x = simulate(white, kPowerSamples, seed, k);
    Eigen::VectorXd y =
        Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
    y.array() *= (0.5 * strength * course[k].array()).exp();
    out.replicates.push_back(k);
    out.white.push_back(std::move(y));
  }
  return out;
}

// Of 40 unrelated courses, a level of 1 % is passed by more than 3 once in 1,300.
TEST(PowerView, AnUnrelatedCourseExplainsNothingBesideWanderingPower) {
  constexpr std::uint64_t kSeed = 8100;
  constexpr double kOnceIn100 = 3.317;  // nats: half the 99 % quantile of χ² with 1 degree
  int alone = 0;
  int beside = 0;
  for (std::uint64_t i = 0; i < 40; ++i) {
    const auto view = PowerView::of(noise_of(courses(kSeed + 2 * i), 0.6, kSeed + 1000 + i));
    ASSERT_TRUE(view);
    const PowerView::Explained found = view->explained(courses(kSeed + 2 * i + 1));
    EXPECT_FALSE(found.steady);
    alone += found.alone > kOnceIn100 ? 1 : 0;
    beside += found.gain > kOnceIn100 ? 1 : 0;
  }
  RecordProperty("alone", alone);
  EXPECT_GT(alone, 20);  // were squares independent, it would be 0.4
  EXPECT_LE(beside, 3);
}

// A course as slow as a replicate is long, or as levels that stay.
VarianceCourse replicates_apart(std::uint64_t seed, bool stay) {
  const double phi = std::exp(-1.0 / static_cast<double>(kPowerSamples));
  const Model markov{{Term(Process(Ar1{1.0 - phi * phi, phi}))}};
  VarianceCourse out;
  for (std::uint32_t k = 0; k < kPowerReplicates; ++k) {
    const std::vector<double> x = simulate(markov, kPowerSamples, seed, k);
    const auto n = static_cast<Eigen::Index>(x.size());
    Eigen::VectorXd course = Eigen::Map<const Eigen::VectorXd>(x.data(), n);
    if (stay) course.setConstant(course.mean());
    out.samples.emplace_back(std::move(course));
  }
  return out;
}

// Under a wander of this very law, a likelihood ratio of e³ against it comes once in 20 at most
// (Markov's inequality): in 40 sets more than 6 times once in 200.
TEST(PowerView, LevelsThatStayRuleOutAWander) {
  constexpr std::uint64_t kSeed = 8400;
  int stay = 0;
  int wander = 0;
  for (std::uint64_t i = 0; i < 40; ++i) {
    for (const bool still : {true, false}) {
      const auto view =
          PowerView::of(noise_of(replicates_apart(kSeed + i, still), 0.5, kSeed + 1000 + i));
      ASSERT_TRUE(view);
      (still ? stay : wander) += view->rules_out_wander() ? 1 : 0;
    }
  }
  RecordProperty("stay", stay);
  RecordProperty("wander", wander);
  EXPECT_GT(stay, 30);
  EXPECT_LE(wander, 6);
}

TEST(PowerView, TheCourseItselfExplainsAll) {
  const VarianceCourse course = courses(8300);
  const auto view = PowerView::of(noise_of(course, 0.6, 8301));
  ASSERT_TRUE(view);
  const PowerView::Explained found = view->explained(course);
  EXPECT_TRUE(found.steady);
  EXPECT_GT(found.gain, 20.0);
}

TEST(PowerView, OfSteadyNoiseNothingWanders) {
  const auto view = PowerView::of(noise_of(courses(8400), 0.0, 8401));
  ASSERT_TRUE(view);
  EXPECT_LT(view->wander_gain(), 5.0);
  EXPECT_EQ(view->of_means().inflation, 1.0);
}

TEST(PowerView, AReplicateThatIsTooShortGivesNone) {
  Innovations few{{0}, {Eigen::VectorXd::LinSpaced(200, -1.0, 1.0)}};
  EXPECT_FALSE(PowerView::of(few));
}

// Beside an unrelated slow witness: neither that witness nor the replicates are named.
TEST(Diagnose, PowerThatWandersByItself) {
  constexpr std::uint64_t kSeed = 8500;
  MadeSubject made{.samples = kPowerSamples, .seed = kSeed};
  const VarianceCourse power = courses(kSeed);
  const VarianceCourse unrelated = courses(kSeed + 1);
  const auto at = [](double s) {
    return static_cast<Eigen::Index>(std::lround(s * kPowerRate.value));
  };
  const Innovations noise = noise_of(power, 0.8, kSeed + 2);
  made.model = "WN(sigma2=0.2) + RW(gamma2=1e-5)";
  made.added = [&](std::size_t k, double s) { return noise.white[k](at(s)); };
  made.temperature = [&](std::size_t k, double s) { return unrelated[k](at(s)); };
  const Diagnosis diagnosis = diagnose(fitted(subject_of(made)));
  ASSERT_FALSE(diagnosis.effects.empty());
  EXPECT_EQ(diagnosis.effects[0].tried.cause, "variance_wander");
  EXPECT_EQ(diagnosis.verdict, DiagnosisVerdict::kOneOf);
  for (const RankedTerm& one : diagnosis.effects) {
    const bool wrong =
        one.tried.cause == "modulated_variance" || one.tried.cause == "replicate_change";
    EXPECT_FALSE(wrong && one.familywise_p < 0.01) << one.tried.cause;
  }
}

// Levels that differ between replicates and stay within them: no recording shows a time longer than
// itself.
TEST(VarianceWander, ItsTimeIsNoLongerThanTheReplicates) {
  const auto slow = parse_full_model("WN + variance_wander(tau=1e5, deviation=1)", Hertz{50.0});
  int sought = 0;
  for (std::uint64_t seed = 8500; seed < 8510; ++seed) {
    const FittedModel plain =
        fitted(with_effects(*subject_of({.seed = seed}), slow->effects, seed));
    const Current current = current_of(plain.regression, plain.fit);
    for (const Suggestion& one : effect_named("variance_wander").search(SearchView(current))) {
      EXPECT_LE(std::get<EffectTerm>(one.added)["tau"], current.subject().seconds(0)) << seed;
      ++sought;
    }
  }
  EXPECT_EQ(sought, 10);
}

// What each distribution gains over the normal one is what a fit with it gains, wherever the level
// of the noise settles.
TEST(Diagnose, HeavyTailsAndBurstsAreNoOutliers) {
  constexpr std::uint64_t kSeed = 8600;
  const std::pair<const char*, const char*> kinds[] = {
      {"heavy_tails", "WN + heavy_tails(dof=4, size=2)"},
      {"bursts", "WN + bursts(length=2, every=20, ratio=6)"}};
  for (const auto& [cause, text] : kinds) {
    const auto hidden = parse_full_model(text, kPowerRate)->effects;
    const Diagnosis diagnosis =
        diagnose(fitted(with_effects(*subject_of({.seed = kSeed}), hidden, kSeed + 1)));
    ASSERT_FALSE(diagnosis.effects.empty());
    const TriedTerm& first = diagnosis.effects[0].tried;
    EXPECT_EQ(first.cause, cause);
    EXPECT_EQ(diagnosis.verdict, DiagnosisVerdict::kFound);
    EXPECT_NEAR(first.likelihood_gain, first.suggestion.score_nats,
                0.05 * first.suggestion.score_nats);
    ASSERT_TRUE(diagnosis.effects[0].heldout);
    // Held-out levels differ more before: bursts come as they like.
    EXPECT_GT(
        diagnosis.effects[0].heldout->total_likelihood() - diagnosis.heldout->total_likelihood(),
        0.95 * first.likelihood_gain);
  }
}

}  // namespace
}  // namespace imunoise
