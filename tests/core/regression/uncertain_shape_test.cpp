// Intervals of a coefficient behind a lag that is an estimate, too.

#include "core/regression/uncertain_shape.h"

#include <gtest/gtest.h>

#include <iostream>

#include "core/diagnosis/searches.h"
#include "core/effects/known_effects.h"
#include "core/regression/current.h"
#include "tests/core/diagnosis/subject_of.h"
#include "tests/support/figures_alone.h"

namespace imunoise {
namespace {

double temperature(std::size_t k, double s) {
  return wave(0.013 + 0.002 * static_cast<double>(k), s) + wave(0.03, s + 3.0) + 0.01 * s;
}

// The coupling behind a lag that explains most.
EffectTerm lagged(const Current& current) {
  const Effect* const witness = &effect_named("witness");
  const Suggestions all = search_effects(current, {&witness, 1});
  EffectTerm best(*witness);
  double most = 0.0;
  for (const Suggestion& one : all) {
    const auto& term = std::get<EffectTerm>(one.added);
    if (!(term["lag"] > 0.0) || !(one.score_nats > most)) continue;
    most = one.score_nats;
    best = term;
  }
  return best;
}

// Of 100 intervals of 95 %, fewer than 85 hold the truth once in 27,000 times (binomial).
TEST(UncertainShape, IntervalsHoldTheCoefficientBehindALag) {
  FIGURES_ALONE();
  constexpr int kSets = 100;
  constexpr double kTruth = 0.4;
  const FullModel truth =
      *parse_full_model("WN + witness(temperature, lag=8, coefficient=0.4)", Hertz{50.0});
  int held = 0;
  double growth = 0.0;
  for (std::uint64_t seed = 1; seed <= kSets; ++seed) {
    const FittedModel plain = fitted(
        with_effects(*subject_of({.samples = 4096, .seed = seed, .temperature = temperature}),
                     truth.effects, seed));
    const Current current = current_of(plain.regression, plain.fit);
    const FittedModel model = fit_with(current, lagged(current));
    const ReportedNumber found = fitted_numbers({model, 0}).at(0);
    held += *found.lower <= kTruth && kTruth <= *found.upper ? 1 : 0;
    growth += growth_by_shape({model, 0})(0) / kSets;
  }
  std::cout << "seeds 1 to " << kSets << ": " << held << " hold it; errors grow by " << growth
            << "\n";
  EXPECT_GE(held, 85);
}

TEST(UncertainShape, NothingGrowsWithoutATimeConstant) {
  const FittedModel plain = fitted(subject_of({.samples = 1024, .temperature = temperature}),
                                   "WN + RW + witness(temperature)");
  EXPECT_EQ(growth_by_shape({plain, 0})(0), 1.0);
}

}  // namespace
}  // namespace imunoise
