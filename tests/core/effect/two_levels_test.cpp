// Jumps between two levels: the algebra of steps against explicit regressors, and courses whose
// jumps are known.

#include "core/effects/two_levels.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/diagnosis/heldout.h"
#include "core/effects/known_effects.h"
#include "core/spectrum/cosine_transform.h"
#include "tests/core/diagnosis/subject_of.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

Eigen::ArrayXd step_cosines(Index n, Index t) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  x.tail(n - t).setOnes();
  return cosine_transform(x);
}

TEST(StepProducts, AreThoseOfStepsInTheTransform) {
  const FittedModel trial = fitted(subject_of({.samples = 512, .replicates = 1, .seed = 21}));
  const Current current = current_of(trial.regression, trial.fit);
  const StepProducts steps = step_products(current)[0];
  const Eigen::ArrayXd& spectrum = current.spectrum[0];
  EXPECT_EQ(steps.size(), 512);
  for (const Index s : {1, 77, 300, 511}) {
    const Eigen::ArrayXd one = step_cosines(512, s);
    const double product = (one * current.cosines[0].array() / spectrum).sum();
    EXPECT_NEAR(steps.product(s), product, 1e-9 * std::abs(product) + 1e-9) << s;
    for (const Index t : {5, 77, 400}) {
      const double information = (one * step_cosines(512, t) / spectrum).sum();
      EXPECT_NEAR(steps.information(s, t), information, 1e-9 * steps.information(256, 256));
    }
  }
  for (const Index end : {0, 512}) {
    EXPECT_NEAR(steps.product(end), 0.0, 1e-9);
    EXPECT_NEAR(steps.information(end, 256), 0.0, 1e-9 * steps.information(256, 256));
  }
}

FittedModel with_telegraph(const FittedModel& plain) {
  return fit_with(current_of(plain.regression, plain.fit), EffectTerm(effect_named("telegraph")));
}

const std::vector<TwoLevelCourse>& courses_of(const FittedModel& fitted) {
  return fitted.regression.subject()
      .found_by<FoundCourses>(EffectTerm(effect_named("telegraph")))
      ->courses;
}

// Up for 20 s, down for 33 s, beginning elsewhere in each replicate.
double level(std::size_t k, double s) {
  return std::fmod(s + 11.0 * static_cast<double>(k), 53.0) < 20.0 ? 1.0 : 0.0;
}

TEST(TwoLevels, KnownJumpsAreFoundWhereTheyAre) {
  const MadeSubject made{.model = "WN(sigma2=1)", .seed = 22, .added = [](std::size_t k, double s) {
                           return 0.8 * level(k, s);
                         }};
  const auto subject = subject_of(made);
  const FittedModel plain = fitted(subject, "WN");
  const FittedModel trial = with_telegraph(plain);
  const std::vector<TwoLevelCourse>& courses = courses_of(trial);
  ASSERT_EQ(courses.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    std::vector<double> jumps;
    for (Index t = 1; t < subject->length(k); ++t) {
      const double at = static_cast<double>(t) / 50.0;
      if (level(k, at) != level(k, at - 0.02)) jumps.push_back(at);
    }
    ASSERT_EQ(courses[k].jumps.size(), jumps.size()) << k;
    // Over u·(noise/height)² samples the likelihood is a Brownian motion less u/2, which is above
    // its start beyond u with a chance of 2Φ(-√u/2) on either side: 4e-4 for all jumps at u = 81.
    for (std::size_t i = 0; i < jumps.size(); ++i)
      EXPECT_NEAR(static_cast<double>(courses[k].jumps[i]) / 50.0, jumps[i],
                  81.0 / (0.8 * 0.8) / 50.0);
  }
  const double error = std::sqrt(trial.fit.effects.covariance(0, 0));
  EXPECT_NEAR(trial.fit.effects.value(0), 0.8, 4.0 * error);
}

// The walk of the model takes strong jumps for its own: only their edges are left.
TEST(TwoLevels, StrongJumpsAreNotTheWalks) {
  constexpr std::size_t kJumps = 20 + 20 + 21 + 20;  // one each 7 or 9 s
  const auto often = [](std::size_t k, double s) {
    return std::fmod(s + 3.0 * static_cast<double>(k), 16.0) < 7.0 ? 1.0 : 0.0;
  };
  for (const double height : {2.0, 5.0, 20.0}) {
    const FittedModel trial = with_telegraph(fitted(subject_of(
        {.seed = 27, .added = [&](std::size_t k, double s) { return height * often(k, s); }})));
    std::size_t jumps = 0;
    for (const TwoLevelCourse& one : courses_of(trial)) jumps += one.jumps.size();
    EXPECT_EQ(jumps, kJumps) << height;
    const double error = std::sqrt(trial.fit.effects.covariance(0, 0));
    EXPECT_NEAR(trial.fit.effects.value(0), height, 4.0 * error) << height;
  }
}

// Levels far apart show dwells of 0.1 s, too: a third of a place of the grid.
TEST(TwoLevels, BriefDwellsAreFound) {
  const auto briefly = [](std::size_t k, double s) {
    const double at = std::fmod(s + 3.0 * static_cast<double>(k), 16.0);
    return at < 7.0 || (at > 11.0 && at < 11.1) ? 1.0 : 0.0;
  };
  const FittedModel trial = with_telegraph(fitted(subject_of(
      {.seed = 28, .added = [&](std::size_t k, double s) { return 10.0 * briefly(k, s); }})));
  for (std::size_t k = 0; k < 4; ++k) {
    std::vector<Index> jumps;
    for (Index t = 1; t < 8192; ++t) {
      const double before = static_cast<double>(t - 1) / 50.0;
      if (briefly(k, static_cast<double>(t) / 50.0) != briefly(k, before)) jumps.push_back(t);
    }
    EXPECT_EQ(courses_of(trial)[k].jumps, jumps) << k;
  }
}

// Only one replicate shows the height: that replicate tells it, and pays for it.
TEST(TwoLevels, OneVisitIsHeldOutWithItsOwnHeight) {
  const auto subject = subject_of({.seed = 30, .added = [](std::size_t k, double s) {
                                     return k == 0 && s > 45.0 && s < 46.0 ? 5.0 : 0.0;
                                   }});
  const FittedModel plain = fitted(subject);
  const FittedModel trial = with_telegraph(plain);
  const double gained = held_out(trial)->nats[0] - held_out(plain)->nats[0];
  // 0.5·5²·50 nats of the visit's samples, less the level beside it, and less its times.
  EXPECT_GT(gained, 100.0);
}

// Under white noise almost alone, a Markov process would be hundreds of jumps.
TEST(TwoLevels, AMarkovProcessIsNotHundredsOfJumps) {
  const FittedModel trial = with_telegraph(
      fitted(subject_of({.model = "WN(sigma2=1) + AR1(phi=0.9, sigma2=0.3)", .seed = 29})));
  for (const TwoLevelCourse& one : courses_of(trial)) EXPECT_LT(one.jumps.size(), 64U);
  EXPECT_TRUE(std::isfinite(more_levels(trial, courses_of(trial)).statistic));
}

TEST(TwoLevels, NoiseHasNone) {
  for (const std::uint64_t seed : {23U, 24U, 25U}) {
    const FittedModel plain = fitted(subject_of({.seed = seed}));
    const TwoLevels found = find_two_levels(step_products(current_of(plain.regression, plain.fit)));
    EXPECT_LT(found.gain_nats - log_places(found.courses), 5.0) << "seed " << seed;
  }
}

TEST(TwoLevels, MoreThanTwoAreNoticed) {
  const auto two = [](std::size_t k, double s) { return 0.8 * level(k, s); };
  const auto three = [](std::size_t k, double s) {
    return 0.8 * (level(k, s) + level(k, s + 10.0));  // 0, 1 and 2, ten seconds each
  };
  const auto bumps = [](std::size_t k, double s) {
    return 1.5 * std::exp(-std::fmod(s + 11.0 * static_cast<double>(k), 53.0) / 6.0);
  };
  const auto seen = [](const Addition& added) {
    const FittedModel plain =
        fitted(subject_of({.model = "WN(sigma2=1)", .seed = 26, .added = added}), "WN");
    const FittedModel trial = with_telegraph(plain);
    return more_levels(trial, courses_of(trial));
  };
  EXPECT_GT(seen(two).p_value, 1e-3);
  EXPECT_LT(seen(three).p_value, 1e-3);
  EXPECT_LT(seen(bumps).p_value, 1e-3);
}

}  // namespace
}  // namespace imunoise
