// The error that falls: the true effect of each family of the catalogue is added at δ ≥ 12, and the
// unexplained error and its views must fall as an oracle's do; a wrong term must gain nothing.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "core/support/parallel.h"
#include "tests/hidden_effects/scoring/error_fall.h"
#include "tests/hidden_effects/trial_plan.h"

namespace imunoise::hidden {
namespace {

void print(const std::string& name, const FallScore& score) {
  std::printf("| %-24s | %-15s | %-15s | %4.0f %% | %-15s | %-15s | %-15s | %-15s |\n",
              name.c_str(), to_string(score.enough).c_str(), to_string(score.found).c_str(),
              100.0 * median(score.shares).value_or(0.0), to_string(score.at_floor).c_str(),
              to_string(score.as_clean).c_str(), to_string(score.risen).c_str(),
              to_string(score.wrong).c_str());
  std::fflush(stdout);
}

TEST(ErrorFallTrial, EveryEffectOfTheCatalogue) {
  const TrialPlan plan = trial_plan();
  FallScore all;
  std::string worth_a_look;
  std::printf(
      "| effect | falls by 80 %% of the oracle's fall | where that is 20 nats | median | "
      "failing view at its floor | or as without the effect | another view rose | "
      "wrong terms beyond chance |\n");
  for (const HiddenEffect& effect : hidden_effects()) {
    if (effect.kind != Kind::kCatalogue || !plan.wants(effect.name())) continue;
    std::vector<CaseSpec> specs;
    for (const double delta : plan.strengths_or({12.0, 16.0})) {
      for (std::size_t i = 0; i < plan.repeats; ++i)
        specs.push_back(plan.one_effect(effect.name(), delta, i));
    }
    const std::vector<Outcome> outcomes = diagnose_all(specs);
    std::vector<std::optional<ErrorFall>> falls(outcomes.size());
    for_each_index(falls.size(), [&](std::size_t i) { falls[i] = error_fall(outcomes[i]); });
    FallScore score;
    for (std::size_t i = 0; i < falls.size(); ++i) {
      if (!falls[i]) continue;
      const ErrorFall& fall = *falls[i];
      score.add(fall);
      const bool wrong = std::any_of(fall.wrong.begin(), fall.wrong.end(),
                                     [](const WrongTerm& one) { return one.beyond_chance(); });
      const bool stays = !fall.failing.empty() && !fall.at_floor;
      if (!fall.enough() || stays || !fall.risen.empty() || wrong)
        worth_a_look += "  " + describe(outcomes[i], fall) + "\n";
    }
    print(effect.name(), score);
    all.add(score);
  }
  print("all", all);
  std::printf("missed goals:\n%s", worth_a_look.c_str());
  EXPECT_GE(all.enough.upper(), 0.95);
  EXPECT_GE(all.at_floor.upper(), 0.90);
  EXPECT_LE(all.risen.lower(), 0.05);
  EXPECT_LE(all.wrong.lower(), 0.05);
}

}  // namespace
}  // namespace imunoise::hidden
