// Placebos: copies of other replicates, and random signs.

#include "core/diagnosis/placebo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/diagnosis/candidates.h"
#include "tests/core/diagnosis/subject_of.h"
#include "tests/support/figures_alone.h"

namespace imunoise {
namespace {

bool could_be(const RankedTerm& one, const std::string& id) {
  return std::find(one.confused_with.begin(), one.confused_with.end(), id) !=
         one.confused_with.end();
}

// A swing of the witness that is the same in each replicate, but for `differs`.
MadeSubject swinging(double differs, std::uint64_t seed, std::size_t shorter = 0) {
  const auto course = [differs](std::size_t k, double s) {
    return wave(0.011 + differs * static_cast<double>(k), s) + 0.5 * wave(0.027, s + 2.0);
  };
  return {.shorter = shorter,
          .seed = seed,
          .added = [course](std::size_t k, double s) { return 0.5 * course(k, s); },
          .temperature = course};
}

TEST(Placebo, ACourseThatAllReplicatesShareCountsOnce) {
  FIGURES_ALONE();
  for (const std::size_t shorter : {0U, 700U}) {
    const Diagnosis diagnosis = diagnose(fitted(subject_of(swinging(0.0, 8700, shorter))));
    ASSERT_FALSE(diagnosis.effects.empty());
    EXPECT_EQ(diagnosis.effects[0].tried.cause, "temperature");
    EXPECT_EQ(diagnosis.verdict, DiagnosisVerdict::kOneOf);
    EXPECT_TRUE(could_be(diagnosis.effects[0], "common_course"));
  }
}

TEST(Placebo, ACourseThatDiffersIsTheWitnessItself) {
  const Diagnosis diagnosis = diagnose(fitted(subject_of(swinging(0.004, 8701))));
  ASSERT_FALSE(diagnosis.effects.empty());
  EXPECT_EQ(diagnosis.effects[0].tried.cause, "temperature");
  EXPECT_EQ(diagnosis.verdict, DiagnosisVerdict::kFound);
}

// Copies from shorter replicates end early. That alone says nothing: a step there once hid what
// slow noise lets a course explain, and copies seemed as good.
TEST(Placebo, ACourseThatDiffersIsTheWitnessItselfInReplicatesOfEveryLength) {
  const auto course = [](std::size_t k, double s) {  // half a period or less
    return wave(0.002 + 0.001 * static_cast<double>(k), s + 90.0 * static_cast<double>(k));
  };
  for (std::uint64_t seed = 8710; seed < 8713; ++seed) {
    const Diagnosis diagnosis = diagnose(
        fitted(subject_of({.shorter = 1500,
                           .seed = seed,
                           .added = [&](std::size_t k, double s) { return 0.6 * course(k, s); },
                           .temperature = course})));
    ASSERT_FALSE(diagnosis.effects.empty());
    EXPECT_EQ(diagnosis.effects[0].tried.cause, "temperature");
    EXPECT_FALSE(could_be(diagnosis.effects[0], "common_course")) << seed;
  }
}

// Slow noise that the model lacks, beside a witness that swings as slowly: of 20 such, no coupling
// may be significant. With independent coefficients half of them were.
TEST(Placebo, SlowNoiseIsNoCoupling) {
  constexpr std::uint64_t kSeed = 8800;
  constexpr double kOnceIn1000 = 1e-3;
  int fooled = 0;
  int sure = 0;
  for (std::uint64_t i = 0; i < 20; ++i) {
    const auto subject = subject_of(
        {.model = "WN(sigma2=1) + AR1(sigma2=1e-3, phi=0.999)",
         .samples = 4096,
         .seed = kSeed + i,
         .temperature = [i](std::size_t k, double s) {
           return wave(0.02 + 0.003 * static_cast<double>(k) + 0.001 * static_cast<double>(i), s);
         }});
    const FittedModel plain = fitted(subject, "WN");
    const Current current = current_of(plain.regression, plain.fit);
    const EffectTerm term =
        parse_full_model("WN + witness(temperature)", subject->rate)->effects[0];
    std::vector<TriedTerm> tried =
        try_all(current, {{.cause = "temperature", .added = term, .score_nats = 10.0}});
    ASSERT_EQ(tried.size(), 1U);
    sure += tried[0].log_p < std::log(kOnceIn1000) ? 1 : 0;
    test_placebos(tried, current, 0.0, Placebos::kAll);
    fooled += tried[0].log_p < std::log(kOnceIn1000) ? 1 : 0;
  }
  RecordProperty("without", sure);
  EXPECT_GE(sure, 8);
  EXPECT_LE(fooled, 1);  // 0.02 expected: two or more once in 5,000
}

}  // namespace
}  // namespace imunoise
