// A witness behind two lags: told apart from one lag.

#include <gtest/gtest.h>

#include <cmath>

#include "core/effect/filters.h"
#include "tests/core/diagnosis/subject_of.h"

namespace imunoise {
namespace {

// Heat that comes and goes at several speeds, K.
double heat(std::size_t k, double s) {
  const double shift = 5.0 * static_cast<double>(k);
  return 2.0 * wave(0.013, s + shift) + 2.0 * wave(0.031, s) + wave(0.07, s + 2.0 * shift);
}

// What a diagnosis finds first where a term is in the data.
TriedTerm found_for(const std::string& text, std::uint64_t seed) {
  const auto plain = subject_of({.seed = seed, .temperature = heat});
  const auto model = parse_full_model("WN + " + text, plain->rate);
  return diagnose(fitted(with_effects(*plain, model->effects, seed))).effects.at(0).tried;
}

TEST(TwoLags, AreFound) {
  const TriedTerm best = found_for("two_lags(temperature, fast=4, slow=8, coefficient=1)", 51);
  EXPECT_EQ(best.cause, "temperature");
  ASSERT_EQ(best.term()->effect->name, "two_lags");
  const EffectTerm& term = *best.term();
  EXPECT_NEAR(term["fast"] / term["slow"], 0.5, 1e-3);  // but for rounding
  EXPECT_LT(std::abs(std::log(term["slow"] / 8.0)), 4.0 * best.suggestion.shape_error);
}

TEST(TwoLags, OneLagIsOne) {
  const TriedTerm best = found_for("witness(temperature, lag=8, coefficient=1)", 52);
  EXPECT_EQ(best.cause, "temperature");
  EXPECT_EQ(best.term()->effect->name, "witness");
  EXPECT_LT(std::abs(std::log((*best.term())["lag"] / 8.0)), 4.0 * best.suggestion.shape_error);
}

TEST(TwoLags, TheOrderOfTheLagsDoesNotMatter) {
  Eigen::VectorXd x = Eigen::VectorXd::Random(300);
  x.array() -= x(0);  // at rest before
  EXPECT_LT((lagged(lagged(x, 20.0), 5.0) - lagged(lagged(x, 5.0), 20.0)).norm(), 1e-12);
}

}  // namespace
}  // namespace imunoise
