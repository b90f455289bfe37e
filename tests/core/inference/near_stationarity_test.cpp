#include "core/inference/near_stationarity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/inference/moment_draws.h"
#include "core/support/parallel.h"
#include "tests/core/inference/simulated_sets.h"

namespace imunoise {
namespace {

constexpr std::uint64_t kStationaritySeed = 11;
const std::vector<std::size_t> kSix(6, 20'000);

std::vector<WaveletVariance> sets_of(const std::vector<std::string>& truths) {
  std::vector<WaveletVariance> out;
  for (std::size_t k = 0; k < truths.size(); ++k) {
    out.push_back(testing::simulated_set(testing::model_of(truths[k]), {20'000}, 1,
                                         kStationaritySeed + k)[0]);
  }
  return out;
}

// The four answers. Each truth is far enough from the others for p-values of many digits.
TEST(NearStationarity, TellsMisfitFromHeterogeneity) {
  const std::string stable = "AR1(sigma2=0.05, phi=0.98) + WN(sigma2=1)";
  const std::string louder = "AR1(sigma2=0.05, phi=0.98) + WN(sigma2=1.2)";
  const auto same = sets_of({stable, stable, stable, stable});
  const auto moved = sets_of({stable, louder, stable, louder});

  const NearStationarity good = near_stationarity(testing::model_of("AR1 + WN"), same);
  EXPECT_GT(good.misfit.p_value(), 1e-3);
  EXPECT_GT(good.heterogeneity.p_value(), 1e-3);

  const NearStationarity misfit = near_stationarity(testing::model_of("WN + RW"), same);
  EXPECT_LT(misfit.misfit.p_value(), 1e-9);
  EXPECT_GT(misfit.heterogeneity.p_value(), 1e-3);

  const NearStationarity differs = near_stationarity(testing::model_of("AR1 + WN"), moved);
  EXPECT_GT(differs.misfit.p_value(), 1e-3);
  EXPECT_LT(differs.heterogeneity.p_value(), 1e-9);

  const NearStationarity both = near_stationarity(testing::model_of("WN + RW"), moved);
  EXPECT_LT(both.misfit.p_value(), 1e-9);
  EXPECT_LT(both.heterogeneity.p_value(), 1e-9);
}

TEST(NearStationarity, NamesTheParameterThatMoves) {
  std::vector<std::string> truths;
  // White noise of 1, 1.3, 1, 1.3, ...: a spread of ln(sigma2) of 0.144 about its mean.
  for (int k = 0; k < 6; ++k) {
    truths.push_back(std::string("AR1(sigma2=0.05, phi=0.98) + WN(sigma2=") +
                     (k % 2 == 0 ? "1" : "1.3") + ")");
  }
  const NearStationarity result = near_stationarity(testing::model_of("AR1 + WN"), sets_of(truths));
  ASSERT_EQ(result.spread.size(), 3U);
  for (const ParameterSpread& one : result.spread) {
    const bool white = info(result.pooled.model.terms[one.term].process).name == "WN";
    EXPECT_EQ(one.moves(), white) << one.term << " " << one.parameter;
    if (!white) continue;
    // Six draws of two values have the sample deviation 0.131·√(6/5) exactly; estimation moves each
    // by 1.2 % of its value.
    EXPECT_NEAR(one.relative, 0.5 * std::log(1.3) * std::sqrt(6.0 / 5.0), 0.015);
    EXPECT_LT(one.relative_lower, one.relative);
    EXPECT_GT(one.relative_upper, one.relative);
    EXPECT_NEAR(one.spread, one.relative * one.mean, 1e-12);
  }
}

TEST(NearStationarity, BootstrapIsReproducibleAndAgreesWithTheAsymptoticLaw) {
  const Model truth = testing::model_of("AR1(sigma2=0.05, phi=0.98) + WN(sigma2=1)");
  const auto moments = testing::simulated_set(truth, kSix, 1, kStationaritySeed);
  const Model open = testing::freed(truth);
  constexpr int kSets = 400;
  const NearStationarity many = near_stationarity(open, moments, {kSets, 3});
  const ThreadLimit limit(1);
  const NearStationarity one = near_stationarity(open, moments, {kSets, 3});
  EXPECT_EQ(*many.heterogeneity.bootstrap_p_value, *one.heterogeneity.bootstrap_p_value);
  EXPECT_EQ(*many.misfit.bootstrap_p_value, *one.misfit.bootstrap_p_value);
  EXPECT_EQ(*many.published_p_value, *one.published_p_value);
  for (const BootstrappedTest& test : {many.misfit, many.heterogeneity}) {
    const double p = test.asymptotic.p_value;
    // The bootstrap's own error, and 2 % for the asymptotic law.
    EXPECT_NEAR(*test.bootstrap_p_value, p, testing::binomial_allowance(p, kSets) + 0.02);
  }
}

TEST(NearStationarity, ReplicatesMayDifferInLength) {
  const Model truth = testing::model_of("WN(sigma2=1) + RW(gamma2=1e-5)");
  const auto moments =
      testing::simulated_set(truth, {20'000, 10'000, 30'000, 20'000}, 1, kStationaritySeed);
  const NearStationarity result = near_stationarity(testing::freed(truth), moments, {49, 1});
  EXPECT_GT(result.heterogeneity.p_value(), 1e-3);
  EXPECT_EQ(result.heterogeneity.asymptotic.degrees_of_freedom, 3 * 2);
  EXPECT_GE(*result.heterogeneity.bootstrap_p_value, 1.0 / 50.0);
}

// Drawn moments have the expectation and covariance that they were asked for.
TEST(MomentDraws, HaveTheCovarianceOfTheModel) {
  const Model truth = testing::model_of("WN(sigma2=1) + RW(gamma2=1e-4)");
  const std::vector<WaveletVariance> like = {testing::theory(truth, 5'000)};
  const MomentCovariances covariances = moment_covariances(truth, like);
  const MomentDraws draws(truth, like, covariances);
  constexpr int kDraws = 20'000;
  const Eigen::Index n = like[0].variance.size();
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(n);
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(n, n);
  RandomStream stream(kStationaritySeed);
  for (int i = 0; i < kDraws; ++i) {
    const Eigen::VectorXd off = draws.draw(stream)[0].variance - like[0].variance;
    mean += off / kDraws;
    square += off * off.transpose() / kDraws;
  }
  const Eigen::VectorXd deviation = covariances[0].diagonal().cwiseSqrt();
  for (Eigen::Index i = 0; i < n; ++i) {
    // Scales of few degrees of freedom are skew; the cube of a normal number is 2 % off there.
    EXPECT_NEAR(mean(i) / deviation(i), 0.0, 0.05) << i;
    for (Eigen::Index j = 0; j <= i; ++j) {
      const double scale = deviation(i) * deviation(j);
      EXPECT_NEAR(square(i, j) / scale, covariances[0](i, j) / scale, 0.08) << i << " " << j;
    }
  }
}

}  // namespace
}  // namespace imunoise
