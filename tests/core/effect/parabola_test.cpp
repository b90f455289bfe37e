// A quadratic coupling whose vertex lies away from the replicates' mean temperatures.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/diagnosis/subject_of.h"

namespace imunoise {
namespace {

constexpr double kVertex = 301.0;   // K
constexpr double kPerSquare = 0.1;  // 1/K²

// Swings of 3 K about a temperature that differs between replicates, by 6 K from the vertex at
// most.
double temperature_of(std::size_t k, double s) {
  static constexpr double kMeans[] = {295.0, 299.0, 304.0, 307.0};
  return kMeans[k] + 3.0 * wave(0.011, s + 7.0 * static_cast<double>(k)) + wave(0.031, s);
}

TriedTerm found_under(const Addition& added, std::uint64_t seed) {
  const auto subject = subject_of({.seed = seed, .added = added, .temperature = temperature_of});
  return diagnose(fitted(subject)).effects.at(0).tried;
}

TEST(Parabola, ItsVertexIsFound) {
  constexpr std::uint64_t kSeed = 61;
  const auto parabola = [](std::size_t k, double s) {
    const double from = temperature_of(k, s) - kVertex;
    return kPerSquare * from * from;
  };
  const TriedTerm best = found_under(parabola, kSeed);
  EXPECT_EQ(best.cause, "temperature");
  ASSERT_NE(best.term(), nullptr);
  const EffectTerm& term = *best.term();
  ASSERT_EQ(term["quadratic"], 1.0) << print(term);
  EXPECT_NEAR(term["vertex"], kVertex, 5.0 * best.suggestion.shape_error);
  EXPECT_LT(best.suggestion.shape_error, 0.5);
  // Nothing of it is left: the coefficient is the true one.
  const JointFit& fit = best.fitted.fit;
  EXPECT_NEAR(fit.effects.value(0), kPerSquare, 5.0 * std::sqrt(fit.effects.covariance(0, 0)));
}

TEST(Parabola, AStraightLineIsNone) {
  constexpr std::uint64_t kSeed = 62;
  const TriedTerm best = found_under(
      [](std::size_t k, double s) { return 0.5 * (temperature_of(k, s) - kVertex); }, kSeed);
  EXPECT_EQ(best.cause, "temperature");
  EXPECT_EQ((*best.term())["quadratic"], 0.0) << print(*best.term());
}

TEST(Parabola, OnlyASquareHasAVertex) {
  const auto read = parse_full_model("WN + witness(temperature, vertex=300)", Hertz{1.0});
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("quadratic"), std::string::npos) << read.error().message;
}

}  // namespace
}  // namespace imunoise
