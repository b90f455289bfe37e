// Effects as regressors: against dense generalised least squares, and in law.

#include "core/regression/regression.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/effect/filters.h"
#include "core/effects/known_effects.h"
#include "core/spectrum/cosine_transform.h"
#include "core/support/linear_algebra.h"
#include "tests/core/diagnosis/subject_of.h"

namespace imunoise {
namespace {

TEST(Lag, AStepIsFollowedExponentially) {
  Eigen::VectorXd x = Eigen::VectorXd::Ones(50);
  x(0) = 0.0;
  const Eigen::VectorXd y = lagged(x, 7.0);
  for (Eigen::Index t = 0; t < y.size(); ++t)
    EXPECT_NEAR(y(t), 1.0 - std::exp(-static_cast<double>(t) / 7.0), 1e-12);
}

// Two replicates beside a temperature that swings slowly and fast.
std::shared_ptr<const Subject> with_waves_of_temperature(std::size_t samples) {
  return subject_of(
      {.samples = samples, .replicates = 2, .seed = 3, .temperature = [](std::size_t k, double s) {
         return std::sin(0.7 * s) + 0.2 * std::cos(11.0 * s + static_cast<double>(k));
       }});
}

// Samples and transforms of what is left come on two ways.
TEST(Regression, WhatIsLeftIsTheSameInTimeAndInFrequency) {
  const auto subject = with_waves_of_temperature(1000);
  const FullModel model = *parse_full_model(
      "WN + ramp + warm_up(tau=3) + line(f=3, harmonics=2) + step(replicate=2, t=7) + "
      "witness(temperature) + witness(temperature, lag=2) + witness(temperature, quadratic) + "
      "witness(temperature, derivative) + witness(temperature, to=1) + witness(temperature, own) + "
      "witness(temperature, octaves=3) + witness(temperature, to=9, octaves=2, own)",
      subject->rate);
  for (const EffectTerm& term : model.effects) {
    const Regression regression = Regression(subject).with(term);
    Eigen::VectorXd coefficients(static_cast<Eigen::Index>(regression.coefficients().size()));
    for (Eigen::Index i = 0; i < coefficients.size(); ++i)
      coefficients(i) = 1.5 - static_cast<double>(i);
    for (std::size_t k = 0; k < 2; ++k) {
      const Eigen::VectorXd samples = regression.residual_samples(coefficients, k);
      const Eigen::VectorXd cosines = regression.residual_cosines(coefficients, k);
      EXPECT_LT((cosine_transform(samples) - cosines).norm(), 1e-10 * cosines.norm())
          << print(term) << " in " << k;
    }
  }
}

// Taking an effect out of a regression leaves what was never made with it; columns that are nothing
// at some frequencies are nothing there to the others.
TEST(Regression, LessAnEffectIsNeverHavingHadIt) {
  const auto subject = with_waves_of_temperature(2000);
  const FullModel model = *parse_full_model(
      "WN(sigma2=1) + RW(gamma2=1e-4) + ramp + line(f=3) + step(replicate=2, t=7) + "
      "witness(temperature, to=9, octaves=3) + witness(temperature, derivative, own) + own_powers",
      subject->rate);
  const auto made_without = [&](std::size_t left_out) {
    Regression out(subject);
    for (std::size_t e = 0; e < model.effects.size(); ++e) {
      if (e != left_out) out = out.with(model.effects[e]);
    }
    return out;
  };
  const Regression all = made_without(model.effects.size());
  for (std::size_t e = 0; e < model.effects.size(); ++e) {
    const Regression less = all.without(e);
    const Regression never = made_without(e);
    const EffectCoefficients found = less.under(model.noise);
    const EffectCoefficients expected = never.under(model.noise);
    ASSERT_EQ(found.value.size(), expected.value.size()) << print(model.effects[e]);
    EXPECT_EQ((found.value - expected.value).norm(), 0.0) << print(model.effects[e]);
    EXPECT_EQ((found.covariance - expected.covariance).norm(), 0.0) << print(model.effects[e]);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ((less.residual(found.value)[k].power - never.residual(found.value)[k].power)
                    .matrix()
                    .norm(),
                0.0)
          << print(model.effects[e]) << " in " << k;
      // What is left has the power that the products say.
      const double squares = less.residual_cosines(found.value, k).squaredNorm();
      const BandedPower left = less.residual(found.value)[k];
      EXPECT_NEAR((left.count * left.power).sum(), squares, 1e-9 * squares)
          << print(model.effects[e]) << " in " << k;
    }
  }
}

// The beginnings of recordings are those of shorter recordings, with the same effects in them.
TEST(Regression, BeginningsAreShorterRecordings) {
  constexpr std::size_t kShort = 400;
  const auto made = [](std::size_t samples) {
    return subject_of({.samples = samples,
                       .replicates = 2,
                       .seed = 11,
                       .temperature = [](std::size_t k, double s) {
                         return 300.0 + 2.0 * static_cast<double>(k) + std::sin(0.7 * s);
                       }});
  };
  const auto whole = made(1000);
  const auto begun = made(kShort);
  const FullModel model = *parse_full_model(
      "WN(sigma2=1) + RW(gamma2=1e-5) + ramp + line(f=3) + step(replicate=2, t=7) + "
      "step(replicate=1, t=15) + witness(temperature, quadratic, vertex=301)",
      whole->rate);
  Regression cut(whole);
  Regression short_one(begun);
  for (const EffectTerm& term : model.effects) {
    cut = cut.with(term);
    const bool behind = term.effect->name == "step" && term["t"] == 15.0;
    if (!behind) short_one = short_one.with(term);
  }
  cut = cut.beginnings(kShort);
  ASSERT_EQ(cut.subject().length(0), begun->length(0));
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_NEAR(cut.subject().witnesses[0].levels[k], begun->witnesses[0].levels[k], 1e-9);
  const Eigen::VectorXd expected = short_one.under(model.noise).value;
  const Eigen::VectorXd found = cut.under(model.noise).value;
  // The step behind the end (coefficient 6, after the ramp, two waves of two replicates, a step) is
  // not felt.
  ASSERT_EQ(found.size(), expected.size() + 1);
  EXPECT_LT((found.head(6) - expected.head(6)).norm(), 1e-8 * expected.norm());
  EXPECT_EQ(found(6), 0.0);
  EXPECT_LT((found.tail(1) - expected.tail(1)).norm(), 1e-8 * expected.norm());
}

// The transform makes white noise plus a walk independent, so that banded least squares differ from
// dense ones only in that the spectrum is one number a band; the first 256 coefficients have a band
// each.
TEST(Regression, IsGeneralisedLeastSquares) {
  const auto subject = subject_of({.samples = 250, .replicates = 2, .seed = 7});
  const Model noise = *parse_model("WN(sigma2=1) + RW(gamma2=1e-2)", subject->rate);
  const Regression regression = Regression(subject)
                                    .with(EffectTerm(effect_named("ramp")))
                                    .with(EffectTerm(effect_named("line"), "", {{"f", 3.0}}));
  const Eigen::Index n = 250;
  // Differences take the unknown level out; their covariance is tridiagonal plus the walk's.
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n - 1, n - 1);
  for (Eigen::Index i = 0; i < n - 1; ++i) {
    covariance(i, i) = 2.0 + 1e-2;
    if (i > 0) covariance(i, i - 1) = covariance(i - 1, i) = -1.0;
  }
  const Eigen::MatrixXd inverse = positive_inverse(covariance).matrix;
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(5, 5);
  Eigen::VectorXd moment = Eigen::VectorXd::Zero(5);
  for (std::size_t k = 0; k < 2; ++k) {
    Eigen::MatrixXd design = Eigen::MatrixXd::Zero(n, 5);
    for (Eigen::Index t = 0; t < n; ++t) {
      const double seconds = static_cast<double>(t) / 50.0;
      const auto own = 1 + 2 * static_cast<Eigen::Index>(k);
      design(t, 0) = seconds;
      design(t, own) = std::cos(2.0 * std::numbers::pi * 3.0 * seconds);
      design(t, own + 1) = std::sin(2.0 * std::numbers::pi * 3.0 * seconds);
    }
    const Eigen::MatrixXd d = design.bottomRows(n - 1) - design.topRows(n - 1);
    const Eigen::VectorXd y = subject->samples[k].tail(n - 1) - subject->samples[k].head(n - 1);
    gram += d.transpose() * inverse * d;
    moment += d.transpose() * inverse * y;
  }
  const Eigen::MatrixXd dense = pseudo_inverse(gram).matrix;
  const EffectCoefficients found = regression.under(noise);
  for (Eigen::Index i = 0; i < 5; ++i) {
    EXPECT_NEAR(found.covariance(i, i) / dense(i, i), 1.0, 1e-6) << i;
    EXPECT_NEAR(found.value(i), (dense * moment)(i), 1e-4 * std::sqrt(dense(i, i))) << i;
  }
  // Each coefficient takes one degree of freedom.
  double taken = 0.0;
  for (const Eigen::ArrayXd& share : regression.leverage(found, noise)) taken += share.sum();
  EXPECT_NEAR(taken, 5.0, 1e-6);
}

TEST(Regression, WhatWasAddedIsFoundWithinItsErrors) {
  const auto subject = subject_of({.seed = 11, .added = [](std::size_t k, double s) {
                                     return 0.02 * s +
                                            0.3 * std::sin(2.0 * std::numbers::pi * 4.0 * s) +
                                            (k == 1 && s >= 60.0 ? 0.5 : 0.0);
                                   }});
  const FittedModel trial = fitted(subject, "WN + RW + ramp + line(f=4) + step(replicate=2, t=60)");
  const EffectCoefficients& found = trial.fit.effects;
  const auto z = [&](Eigen::Index i, double truth) {
    return std::abs(found.value(i) - truth) / std::sqrt(found.covariance(i, i));
  };
  constexpr double kOnceInTenThousand = 3.9;
  EXPECT_LT(z(0, 0.02), kOnceInTenThousand);
  for (Eigen::Index k = 0; k < 4; ++k) EXPECT_LT(z(2 + 2 * k, 0.3), kOnceInTenThousand);
  EXPECT_LT(z(found.value.size() - 1, 0.5), kOnceInTenThousand);
}

TEST(Regression, BlocksOfOneReplicateFeelTheSameEffects) {
  const auto subject = subject_of({.replicates = 1, .seed = 14, .added = [](std::size_t, double s) {
                                     return 0.3 * wave(4.0, s) + 2.0 * std::exp(-s / 60.0) +
                                            (s >= 100.0 ? 0.5 : 0.0);
                                   }});
  const FittedModel trial =
      fitted(subject, "WN + RW + line(f=4) + warm_up(tau=60) + step(replicate=1, t=100)");
  const Regression blocks = trial.regression.in_blocks(4);
  ASSERT_EQ(blocks.subject().replicates(), 4U);
  ASSERT_EQ(blocks.coefficients().size(), 4U);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(blocks.coefficients()[i].replicate, CoefficientName::kAll);
  EXPECT_EQ(blocks.coefficients()[3].replicate, 2U);  // 164 s in quarters: the third holds 100 s
  // Effects taken out with what the whole found leave what the whole leaves, block by block.
  const Eigen::VectorXd whole = trial.regression.residual_samples(trial.fit.effects.value, 0);
  for (std::size_t b = 0; b < 4; ++b) {
    const Eigen::Index n = blocks.subject().length(b);
    Eigen::VectorXd expected = whole.segment(static_cast<Eigen::Index>(b) * n, n);
    expected.array() -= expected.mean();
    const Eigen::VectorXd left =
        inverse_cosine_transform(blocks.residual_cosines(trial.fit.effects.value, b));
    EXPECT_LT((left - expected).norm(), 1e-9 * expected.norm()) << b;
  }
}

}  // namespace
}  // namespace imunoise
