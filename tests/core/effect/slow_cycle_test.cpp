// Waves of a few periods a replicate.

#include <gtest/gtest.h>

#include <cmath>

#include "core/diagnosis/candidates.h"
#include "core/search/search_view.h"
#include "tests/core/diagnosis/subject_of.h"

namespace imunoise {
namespace {

// 3.3 to 6 periods of 0.6 in white noise and a walk: the wave, not the grid of the search, says the
// frequency. Of 12 intervals of 95 %, 9 or fewer hold the truth once in 500.
TEST(SlowCycle, HasItsFrequency) {
  constexpr double kSeconds = 8192.0 / 50.0;
  int held = 0;
  for (int i = 0; i < 12; ++i) {
    const double hertz = (3.3 + 0.25 * i) / kSeconds;
    const auto subject = subject_of({.model = "WN(sigma2=1) + RW(gamma2=1e-4)",
                                     .seed = 9300 + static_cast<std::uint64_t>(i),
                                     .added = [&](std::size_t k, double s) {
                                       return 0.6 * wave(hertz, s + 31.0 * static_cast<double>(k));
                                     }});
    const FittedModel plain = fitted(subject, "WN + RW");
    const Current current = current_of(plain.regression, plain.fit);
    const Suggestion found = effect_named("line").search(SearchView(current)).front();
    const double at = std::get<EffectTerm>(found.added)[0];
    held += std::abs(at - hertz) < 1.96 * found.shape_error ? 1 : 0;
    EXPECT_LT(found.shape_error, 0.1 / kSeconds);
    EXPECT_EQ(found.cause == "slow_cycle", at < 0.02);
  }
  EXPECT_GE(held, 10);
}

// A replicate that ended early has less than one period. The others tell the wave.
TEST(SlowCycle, IsNotHiddenByAShortReplicate) {
  constexpr double kHertz = 0.0195;
  const auto subject = subject_of({.model = "WN(sigma2=1) + RW(gamma2=1e-4)",
                                   .first = 2000,
                                   .seed = 9320,
                                   .added = [&](std::size_t k, double s) {
                                     return 0.6 * wave(kHertz, s + 31.0 * static_cast<double>(k));
                                   }});
  const Diagnosis diagnosis = diagnose(fitted(subject, "WN + RW"));
  ASSERT_FALSE(diagnosis.effects.empty());
  const TriedTerm& best = diagnosis.effects[0].tried;
  ASSERT_EQ(best.cause, "slow_cycle");
  EXPECT_NEAR((*best.term())[0], kHertz, 3.0 * best.suggestion.shape_error);
}

}  // namespace
}  // namespace imunoise
