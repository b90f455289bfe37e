// A handful of the blind trial's cases, for every day. Each is far enough from chance that it fails
// only when the diagnosis changes.

#include <gtest/gtest.h>

#include "tests/hidden_effects/scoring/error_fall.h"
#include "tests/hidden_effects/scoring/outcome.h"
#include "tests/hidden_effects/scoring/statistics.h"
#include "tests/support/figures_alone.h"

namespace imunoise::hidden {
namespace {

constexpr std::size_t kShort = 1U << 13U;  // samples of a replicate

Outcome of(std::vector<std::string> effects, double delta, std::size_t samples = kShort,
           bool withhold = false) {
  CaseSpec spec;
  spec.effects = std::move(effects);
  spec.delta = delta;
  spec.seed = 1;
  spec.withhold = withhold;
  spec.samples = samples;
  return diagnose(spec);
}

// Named first; once added, the error falls and the view that failed no longer does.
void expect_named(const char* effect, double delta, std::size_t samples = kShort) {
  const Outcome outcome = of({effect}, delta, samples);
  EXPECT_TRUE(outcome.named(1)) << outcome.describe();
  const auto fall = error_fall(outcome);
  ASSERT_TRUE(fall) << outcome.describe();
  EXPECT_GT(fall->share, 0.6) << outcome.describe();
  EXPECT_TRUE(fall->at_floor || fall->failing.empty()) << fall->failing;
  constexpr double kOnceIn400 = 6.0;  // nats, by chance
  for (const WrongTerm& one : fall->wrong) EXPECT_LT(one.gain, kOnceIn400) << one.term;
}

// One null in twenty may raise an alarm, and which one says little; that it is sure of it may not
// be.
TEST(HiddenEffects, NothingIsFoundInNothing) {
  const Outcome outcome = of({}, 0.0);
  ASSERT_EQ(outcome.error, "");
  EXPECT_EQ(outcome.report.integrity_size(), 0) << outcome.describe();
  for (const v1::EffectCandidate& one : outcome.report.candidates()) {
    EXPECT_GT(one.familywise_p(), 1e-3) << outcome.describe();
  }
}

TEST(HiddenEffects, ALine) { expect_named("line", 16.0); }

// Every diagnosis makes all searches: with sanitizers, one effect stands for all.
TEST(HiddenEffects, TemperatureWithALag) {
  FIGURES_ALONE();
  expect_named("temperature/lagged", 16.0, 2 * kShort);
}
TEST(HiddenEffects, AStep) {
  FIGURES_ALONE();
  expect_named("step", 16.0);
}
TEST(HiddenEffects, ARoundedAngle) {
  FIGURES_ALONE();
  expect_named("quantisation/angle", 16.0);
}

TEST(HiddenEffects, TemperatureThatIsNotInTheFile) {
  FIGURES_ALONE();
  const Outcome outcome = of({"temperature/static"}, 24.0, kShort, true);
  ASSERT_EQ(outcome.error, "");
  EXPECT_TRUE(outcome.detected()) << outcome.describe();
  EXPECT_FALSE(outcome.confidently_wrong()) << outcome.describe();
}

// Textbook values: 0 of 600 nulls bound the rate by 1 - 0.05^(1/600); 8 of 20 has the one-sided
// 95 % bounds 0.2171 and 0.6064 (Clopper & Pearson 1934).
TEST(Share, HasClopperAndPearsonsBounds) {
  EXPECT_NEAR((Share{0, 600}).upper(), 0.0049805, 1e-6);
  EXPECT_EQ((Share{0, 600}).lower(), 0.0);
  EXPECT_NEAR((Share{8, 20}).lower(), 0.2171, 1e-4);
  EXPECT_NEAR((Share{8, 20}).upper(), 0.6064, 1e-4);
}

TEST(StrengthAt90, InterpolatesAndPools) {
  EXPECT_NEAR(*strength_at_90({{6.0, {5, 10}}, {8.0, {10, 10}}}), 7.6, 1e-12);
  EXPECT_EQ(*strength_at_90({{6.0, {10, 10}}, {8.0, {10, 10}}}), 6.0);
  EXPECT_FALSE(strength_at_90({{6.0, {5, 10}}, {8.0, {8, 10}}}));
  // 90 % at δ = 6 does not count when fewer are found at 8: together they are 85 %.
  EXPECT_NEAR(*strength_at_90({{6.0, {9, 10}}, {8.0, {8, 10}}, {10.0, {10, 10}}}), 8.0 + 2.0 / 3.0,
              1e-12);
}

}  // namespace
}  // namespace imunoise::hidden
