// Replicates that differ in the shape of their spectrum, against parts of a replicate that do.

#include "core/search/shape_spread.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/diagnosis/diagnose.h"
#include "core/search/search_view.h"
#include "tests/core/diagnosis/subject_of.h"

namespace imunoise {
namespace {

constexpr std::size_t kShapeSamples = 16384;

// White noise, times something of the replicate and the sample, plus a resonance where that is on.
Innovations shaped(const std::function<double(std::size_t, double)>& level,
                   const std::function<bool(std::size_t, double)>& rings, std::uint64_t seed) {
  const Model white{{Term(Process(WhiteNoise{1.0}))}};
  const Model resonance{{Term(Process(Resonance{0.05, 0.99, 1.0}))}};
  Innovations out;
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::vector<double> noise = simulate(white, kShapeSamples, seed, k);
    const std::vector<double> ringing = simulate(resonance, kShapeSamples, seed + 1, k);
    Eigen::VectorXd y(static_cast<Eigen::Index>(kShapeSamples));
    for (std::size_t t = 0; t < kShapeSamples; ++t) {
      const double at = static_cast<double>(t) / static_cast<double>(kShapeSamples);
      y(static_cast<Eigen::Index>(t)) =
          level(k, at) * (noise[t] + (rings(k, at) ? ringing[t] : 0.0));
    }
    out.replicates.push_back(k);
    out.white.push_back(std::move(y));
  }
  return out;
}

TEST(ShapeSpread, ALevelThatWandersChangesNoShape) {
  const auto wander = [](std::size_t k, double at) {
    return std::exp(0.2 * std::sin(5.0 * at + 2.0 * static_cast<double>(k)));
  };
  const Innovations all = shaped(
      wander, [](std::size_t, double) { return false; }, 8201);
  EXPECT_EQ(shape_spread(all).inflation, 1.0);
  EXPECT_TRUE(std::isinf(shape_spread(all).dof));
}

TEST(ShapeSpread, AResonanceThatComesAndGoesDoes) {
  const auto steady = [](std::size_t, double) { return 1.0; };
  const auto partly = [](std::size_t k, double at) {
    return at < 0.25 * static_cast<double>(k + 1) && at > 0.2 * static_cast<double>(k);
  };
  const ShapeSpread found = shape_spread(shaped(steady, partly, 8203));
  EXPECT_GT(found.inflation, 5.0);
  EXPECT_EQ(found.dof, 12.0);  // four replicates, three degrees of their quarters each
}

// Σ n/2 (r - 1 - log r), where the mean of the r is one.
TEST(ShapeSpread, ALevelOfItsOwnGainsWhatItsLikelihoodSays) {
  Innovations all{{0, 1},
                  {Eigen::VectorXd::Constant(100, 1.0), Eigen::VectorXd::Constant(100, 2.0)}};
  EXPECT_NEAR(level_gain(all), -50.0 * (std::log(1.0 / 2.5) + std::log(4.0 / 2.5)), 1e-9);
}

// The level of all replicates wanders as slowly as they are long, which alone could make them
// differ; one of them is read at another pace.
TEST(ShapeSpread, ReplicatesOfAnotherShapeAreFoundBesideAPowerThatWanders) {
  std::vector<std::vector<double>> noise;
  for (std::uint32_t k = 0; k < 4; ++k) {
    const MovingAverage process{1.0, {k == 3 ? 0.5 : 0.2}};
    noise.push_back(simulate(Model{{Term(process)}}, kShapeSamples, 8205, k));
  }
  const auto subject =
      subject_of({.model = "RW(gamma2=1e-5)",
                  .samples = kShapeSamples,
                  .seed = 8206,
                  .added = [&](std::size_t k, double s) {
                    const double level =
                        std::exp(0.15 * std::sin(0.02 * s + 1.7 * static_cast<double>(k)));
                    return level * noise[k][static_cast<std::size_t>(std::lround(s * 50.0))];
                  }});
  const FittedModel model = fitted(subject, "MA(1) + RW");
  const Current current = current_of(model.regression, model.fit);
  ASSERT_GT(SearchView(current).power()->of_means().inflation, 10.0);
  const Diagnosis diagnosis = diagnose(model);
  const auto found =
      std::find_if(diagnosis.effects.begin(), diagnosis.effects.end(),
                   [](const RankedTerm& one) { return one.tried.cause == "replicate_bandwidth"; });
  ASSERT_NE(found, diagnosis.effects.end());
  EXPECT_LT(found->familywise_p, 1e-10);
}

}  // namespace
}  // namespace imunoise
