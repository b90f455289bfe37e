// What the search for a course common to all replicates takes for one.

#include <gtest/gtest.h>

#include "core/effects/known_effects.h"
#include "core/search/search_view.h"
#include "tests/core/diagnosis/subject_of.h"

namespace imunoise {
namespace {

// Swings of a few tens of seconds, in replicates of 164 s.
double swings(double s) { return wave(0.011, s + 5.0) + 0.7 * wave(0.019, s); }

double score_of(const MadeSubject& made) {
  const FittedModel plain = fitted(subject_of(made));
  const Current current = current_of(plain.regression, plain.fit);
  const Suggestions found = effect_named("common_course").search(SearchView(current));
  return found.empty() ? 0.0 : found.front().score_nats;
}

TEST(CommonCourse, IsTheSameInAllReplicates) {
  constexpr std::uint64_t kSeed = 2026;
  const Addition common = [](std::size_t, double s) { return swings(s); };
  const Addition own = [](std::size_t k, double s) {
    return swings(s + 31.0 * static_cast<double>(k * k));
  };
  EXPECT_GT(score_of({.seed = kSeed, .added = common}), 20.0);
  EXPECT_GT(score_of({.shorter = 1000, .seed = kSeed, .added = common}), 20.0);
  EXPECT_LT(score_of({.seed = kSeed, .added = own}), 2.0);
  EXPECT_LT(score_of({.seed = kSeed}), 2.0);
  EXPECT_EQ(score_of({.replicates = 1, .seed = kSeed, .added = common}), 0.0);
}

}  // namespace
}  // namespace imunoise
