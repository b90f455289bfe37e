// A ladder adds what one look after the other at everything adds.

#include "core/diagnosis/climb.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/diagnosis/candidates.h"
#include "core/diagnosis/searches.h"
#include "tests/core/diagnosis/subject_of.h"
#include "tests/support/figures_alone.h"

namespace imunoise {
namespace {

constexpr double kLevel = 0.05;

double warmth(std::size_t k, double s) {
  return 2.0 * wave(0.013 + 0.002 * static_cast<double>(k), s) + wave(0.05, s + 3.0) + 0.01 * s;
}

// A resonance, a line and a witness that is followed; and a fainter line, which the resonance
// hides.
MadeSubject three_effects() {
  return {.model = "WN(sigma2=1) + RW(gamma2=1e-5) + RES(sigma2=0.3, r=0.95, omega=1)",
          .seed = 19,
          .added =
              [](std::size_t k, double s) {
                return 0.2 * wave(17.123, s) + 0.4 * wave(7.9, s) + 0.3 * warmth(k, s);
              },
          .temperature = warmth};
}

struct Climbed {
  std::vector<std::string> causes;
  FittedModel model;
  DiagnosisVerdict end = DiagnosisVerdict::kNone;
};

Climbed climbed(FittedModel model, Eigen::Index beginning) {
  Diagnosis first = diagnose(model, kLevel);
  Climb climb(first, model, kLevel, beginning);
  NextTerm next;
  next.verdict = first.verdict;
  if (first.worth_adding) next.best = std::move(first.effects.front());
  Climbed out{{}, std::move(model)};
  while (next.best && out.causes.size() < 8) {
    out.causes.push_back(next.best->tried.cause);
    out.model = std::move(next.best->tried.fitted);
    next = climb.next(out.model, next.best->heldout);
  }
  out.end = next.verdict;
  return out;
}

Climbed looked(FittedModel model) {
  Climbed out{{}, std::move(model)};
  for (;;) {
    Diagnosis all = diagnose(out.model, kLevel);
    out.end = all.verdict;
    if (!all.worth_adding || out.causes.size() == 8) return out;
    out.causes.push_back(all.effects.front().tried.cause);
    out.model = std::move(all.effects.front().tried.fitted);
  }
}

void expect_same(Climbed one, Climbed other) {
  std::sort(one.causes.begin(), one.causes.end());
  std::sort(other.causes.begin(), other.causes.end());
  EXPECT_EQ(one.causes, other.causes);
  EXPECT_EQ(one.end, other.end);
  // Shapes found under other models differ by less than their errors: half a nat each.
  EXPECT_NEAR(one.model.fit.log_likelihood, other.model.fit.log_likelihood,
              0.5 * static_cast<double>(one.causes.size()));
}

TEST(Climb, AddsWhatLooksAtEverythingAdd) {
  FIGURES_ALONE();
  const FittedModel start = fitted(subject_of(three_effects()));
  const Climbed all = looked(start);
  EXPECT_EQ(all.causes.size(), 4U) << testing::PrintToString(all.causes);
  EXPECT_EQ(all.end, DiagnosisVerdict::kNone);
  expect_same(climbed(start, 1 << 20), all);
}

// What shows in a quarter of each replicate is proven on the whole; the rest is found there.
TEST(Climb, ByTheBeginningsOfTheReplicates) {
  const FittedModel start = fitted(subject_of(three_effects()));
  expect_same(climbed(start, 8192), looked(start));
}

// The first look saw the second one, beside bursts and wandering power, which explain some of both.
TEST(Climb, TwoChangesOfPowerAreTwo) {
  RandomStream random(9110);
  const auto twice = [&](std::size_t k, double s) {
    const double own = random.normal();
    if (k != 0) return 0.0;
    return (s > 25.0 && s < 50.0 ? std::sqrt(2.0) : s > 90.0 && s < 125.0 ? 1.0 : 0.0) * own;
  };
  const Climbed found =
      climbed(fitted(subject_of({.replicates = 2, .seed = 9111, .added = twice})), 1 << 20);
  EXPECT_EQ(found.causes, (std::vector<std::string>{"power_change", "power_change"}));
  EXPECT_EQ(found.end, DiagnosisVerdict::kNone);
}

TEST(Climb, EndsWhereNothingIs) {
  const FittedModel start = fitted(subject_of({.seed = 20}));
  const Diagnosis first = diagnose(start, kLevel);
  const NextTerm next = Climb(first, start, kLevel, 4096).next(start);
  EXPECT_FALSE(next.best);
  EXPECT_EQ(next.verdict, DiagnosisVerdict::kNone);
  ASSERT_TRUE(next.heldout);
  EXPECT_EQ(next.heldout->nats, first.heldout->nats);
}

// Numbers between -1 and 1, all as likely: nothing in the catalogue makes tails so light.
TEST(Climb, TellsWhatNoCauseExplains) {
  const auto even = [](std::size_t k, double s) {
    const double x = 43758.5453 * std::sin(12.9898 * s + 78.233 * static_cast<double>(k));
    return 2.0 * (x - std::floor(x)) - 1.0;
  };
  const FittedModel start =
      fitted(subject_of({.model = "WN(sigma2=1e-4)", .seed = 21, .added = even}), "WN");
  const Diagnosis first = diagnose(start, kLevel);
  EXPECT_FALSE(first.worth_adding);
  EXPECT_EQ(first.verdict, DiagnosisVerdict::kUnknown);
  EXPECT_EQ(Climb(first, start, kLevel).next(start).verdict, DiagnosisVerdict::kUnknown);
}

bool tries_a_step(const FittedModel& model) {
  const Current current = current_of(model.regression, model.fit);
  const std::vector<TriedTerm> tried = try_all(current, search_all(current));
  return std::any_of(tried.begin(), tried.end(),
                     [](const TriedTerm& one) { return one.cause == "step"; });
}

// A step of 25 nats beside a wave of 8,000: it is fitted once the wave is in the model.
TEST(TryAll, LeavesWhatTheBestMasks) {
  const auto subject =
      subject_of({.model = "WN(sigma2=1)", .seed = 23, .added = [](std::size_t k, double s) {
                    return wave(7.9, s) + (k == 0 && s > 80.0 ? 0.16 : 0.0);
                  }});
  const FittedModel start = fitted(subject, "WN");
  EXPECT_FALSE(tries_a_step(start));
  const Diagnosis first = diagnose(start, kLevel);
  ASSERT_FALSE(first.effects.empty());
  EXPECT_EQ(first.effects.front().tried.cause, "line");
  EXPECT_TRUE(tries_a_step(first.effects.front().tried.fitted));
}

}  // namespace
}  // namespace imunoise
