// Laws that the estimators obey whatever the data.

#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include "core/support/linear_algebra.h"
#include "core/support/parallel.h"
#include "tests/core/inference/simulated_sets.h"
#include "tests/support/figures_alone.h"
#include "tests/support/golden.h"

namespace imunoise {
namespace {

using testing::freed;
using testing::model_of;
using testing::theory;

void expect_same_values(const Model& found, const Model& truth, double tolerance,
                        const std::string& what) {
  for (std::size_t t = 0; t < truth.terms.size(); ++t) {
    const std::vector<double> a = values(found.terms[t].process);
    const std::vector<double> b = values(truth.terms[t].process);
    for (std::size_t p = 0; p < b.size(); ++p) {
      EXPECT_NEAR(a[p], b[p], tolerance * std::abs(b[p]))
          << what << " found " << print_with_values(found);
    }
  }
}

class Exactness : public ::testing::TestWithParam<const char*> {};

TEST_P(Exactness, MomentsOfTheTheoryGiveTheParametersBack) {
  const Model truth = model_of(GetParam());
  for (const Weighting weighting : {Weighting::kDiagonal, Weighting::kFull}) {
    const std::vector<WaveletVariance> moments = {theory(truth, 1U << 18U)};
    const Estimate found = mugmwm(freed(truth), moments, weighting);
    expect_same_values(found.model, truth, 1e-6, GetParam());
    // In units of what a model that explains nothing would score.
    const double nothing = (found.weight_roots[0] * moments[0].variance.matrix()).squaredNorm();
    EXPECT_LT(found.objective, 1e-14 * nothing);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Models, Exactness,
    ::testing::Values("WN(sigma2=2)", "WN(sigma2=1) + RW(gamma2=1e-5)",
                      "WN(sigma2=1) + QN(q2=5) + RW(gamma2=1e-6) + DR(omega2=1e-12)",
                      "AR1(sigma2=0.01, phi=0.99) + WN(sigma2=1)",
                      "AR1(sigma2=1, phi=-0.7) + RW(gamma2=1e-4)",
                      "AR1(sigma2=1e-4, phi=0.9995) + AR1(sigma2=0.1, phi=0.95) + WN(sigma2=1)",
                      "RES(sigma2=0.02, r=0.97, omega=0.3) + WN(sigma2=1)",
                      "MA(1, sigma2=1, theta1=0.4) + RW(gamma2=1e-5)", "FN(b2=0.1) + WN(sigma2=1)",
                      "GM(sigma2=0.2, tc=3) + WN(sigma2=1) + RW(gamma2=1e-7)"));

// In 4 of these seeds from 1 to 3000, weights and estimate chased each other: a short correlation
// time made weights that asked for a long one, and back. The result left 26 standard deviations of
// its own at the longest scales.
TEST(Mugmwm, SettlesOnWeightsOfItsOwn) {
  const Model truth = model_of("WN(sigma2=1) + AR1(sigma2=0.01, phi=0.99)");
  for (const std::uint64_t seed : {488U, 834U, 2028U, 2557U}) {
    const auto moments = testing::simulated_set(truth, {3000, 3000, 3000, 3000}, 1, seed);
    const Estimate found = mugmwm(freed(truth), moments, Weighting::kFull);
    const auto roots = full_roots(found.model, moments);
    double own = 0.0;
    for (std::size_t k = 0; k < moments.size(); ++k) {
      const Eigen::VectorXd left = moments[k].variance.matrix() -
                                   variance(found.model, moments[k].scales.half_widths()).matrix();
      own += (roots[k] * left).squaredNorm();
    }
    EXPECT_LT(own, 3.0 * found.objective + 30.0) << "seed " << seed;
  }
}

TEST(Mugmwm, TakesReplicatesOfUnequalLength) {
  const Model truth = model_of("AR1(sigma2=0.01, phi=0.99) + WN(sigma2=1)");
  const std::vector<WaveletVariance> moments = {theory(truth, 5000), theory(truth, 1U << 17U),
                                                theory(truth, 900)};
  for (const Weighting weighting : {Weighting::kDiagonal, Weighting::kFull}) {
    expect_same_values(mugmwm(freed(truth), moments, weighting).model, truth, 1e-6, "unequal");
  }
  // The long replicate decides: a short one from another truth moves little.
  std::vector<WaveletVariance> mixed = {
      theory(model_of("AR1(sigma2=0.02, phi=0.99) + WN(sigma2=2)"), 900), theory(truth, 1U << 17U)};
  expect_same_values(mugmwm(freed(truth), mixed, Weighting::kFull).model, truth, 0.05, "mixed");
}

TEST(Mugmwm, EqualsTheAverageWhereVarianceIsLinearAndWeightsAreTheSame) {
  const Model open = model_of("WN + QN + RW");
  std::vector<WaveletVariance> moments = {
      theory(model_of("WN(sigma2=1) + QN(q2=1) + RW(gamma2=1e-4)"), 1U << 14U),
      theory(model_of("WN(sigma2=3) + QN(q2=2) + RW(gamma2=3e-4)"), 1U << 14U)};
  for (WaveletVariance& wv : moments) {  // one width for both: the weights are the same
    wv.lower = 0.9 * moments[0].variance;
    wv.upper = 1.1 * moments[0].variance;
  }
  const Estimate pooled = mugmwm(open, moments, Weighting::kDiagonal);
  expect_same_values(pooled.model, agmwm(open, moments, Weighting::kDiagonal).average.model, 1e-9,
                     "linear");
}

// One replicate has a faint slower process, the other a faint faster one: averaged by their order
// in time, each faint one would meet the strong one of the other.
TEST(Agmwm, AveragesTermsThatExplainTheSame) {
  const std::vector<WaveletVariance> moments = {
      theory(model_of("AR1(sigma2=1e-8, phi=0.9999) + AR1(sigma2=0.02, phi=0.99)"), 1U << 14U),
      theory(model_of("AR1(sigma2=0.02, phi=0.99) + AR1(sigma2=2e-3, phi=0.5)"), 1U << 14U)};
  const AverageEstimate found = agmwm(model_of("2*AR1"), moments, Weighting::kDiagonal);
  EXPECT_LT(found.disagreement, 1.2);
}

TEST(Agmwm, SaysWhereTheAverageDescribesNoReplicate) {
  const auto of = [](const std::string& other) {
    return agmwm(model_of("AR1"),
                 std::vector{theory(model_of("AR1(sigma2=1, phi=0.9)"), 1U << 14U),
                             theory(model_of(other), 1U << 14U)},
                 Weighting::kDiagonal)
        .disagreement;
  };
  EXPECT_NEAR(of("AR1(sigma2=1, phi=0.9)"), 1.0, 1e-6);
  // Variances 10,000 / 2 and 5.3 in the mean; that of the mean φ is 10.2.
  EXPECT_GT(of("AR1(sigma2=1, phi=0.9999)"), 50.0);
}

// Two replicates of one model with different parameters: pooling is not averaging (Jensen).
class Jensen : public ::testing::Test {
 protected:
  // Moments of both at dyadic scales, with widths that make Ω the same for both.
  static std::vector<WaveletVariance> pair(const std::string& a, const std::string& b,
                                           std::size_t samples, bool chi_square) {
    std::vector<WaveletVariance> out = {theory(model_of(a), samples), theory(model_of(b), samples)};
    WaveletVariance mean = out[0];
    mean.variance = 0.5 * (out[0].variance + out[1].variance);
    mean.lower = 0.0 * mean.variance;  // Ω = 1 / mean²
    mean.upper = mean.variance;
    if (chi_square) set_chi_square_interval(mean);
    for (WaveletVariance& wv : out) {
      wv.lower = mean.lower;
      wv.upper = mean.upper;
    }
    return out;
  }
};

TEST_F(Jensen, Golden) {
  IMUNOISE_NEEDS("golden/reference.json");
  const auto golden = testing::read_json("golden/reference.json")["jensen"];
  // The file does not state its weights: 14 dyadic scales with Ω = 1 / mean² reproduce its pure AR1
  // pairs.
  for (const auto& [short_one, long_one] : {std::pair("0.98", "0.995"), std::pair("0.9", "0.99")}) {
    const std::string name = std::string("pureAR1 (") + short_one + ", " + long_one + ")";
    const auto moments =
        pair(std::string("AR1(sigma2=1e-3, phi=") + short_one + ")",
             std::string("AR1(sigma2=1e-3, phi=") + long_one + ")", 1U << 15U, false);
    const std::vector<double> pooled =
        values(mugmwm(model_of("AR1"), moments, Weighting::kDiagonal).model.terms[0].process);
    const std::vector<double> average = values(
        agmwm(model_of("AR1"), moments, Weighting::kDiagonal).average.model.terms[0].process);
    EXPECT_NEAR(pooled[0] / golden[name]["mugmwm_s2_phi"][0].get<double>(), 1.0, 1e-6) << name;
    EXPECT_NEAR(pooled[1], golden[name]["mugmwm_s2_phi"][1].get<double>(), 1e-8) << name;
    EXPECT_NEAR(average[0] / golden[name]["agmwm_s2_phi"][0].get<double>(), 1.0, 1e-6) << name;
    EXPECT_NEAR(average[1], golden[name]["agmwm_s2_phi"][1].get<double>(), 1e-8) << name;
  }
  // Its AR1+WN pair is met only roughly by any weights tried: here those of 200,000 samples.
  const auto moments = pair("AR1(sigma2=1e-3, phi=0.98) + WN(sigma2=1)",
                            "AR1(sigma2=1e-3, phi=0.995) + WN(sigma2=1)", 200'000, true);
  const Model pooled = mugmwm(model_of("AR1 + WN"), moments, Weighting::kDiagonal).model;
  EXPECT_NEAR(-1.0 / std::log(values(pooled.terms[0].process)[1]), 149.5, 1.0);
  const Model average = agmwm(model_of("AR1 + WN"), moments, Weighting::kDiagonal).average.model;
  expect_same_values(average, model_of("AR1(sigma2=1e-3, phi=0.9875) + WN(sigma2=1)"), 1e-6,
                     "average");
  // With the same φ, ν is linear in what differs: no Jensen.
  const auto alike = pair("AR1(sigma2=5e-4, phi=0.99) + WN(sigma2=1)",
                          "AR1(sigma2=2e-3, phi=0.99) + WN(sigma2=1)", 200'000, true);
  expect_same_values(mugmwm(model_of("AR1 + WN"), alike, Weighting::kDiagonal).model,
                     model_of("AR1(sigma2=1.25e-3, phi=0.99) + WN(sigma2=1)"), 1e-6, "same phi");
}

TEST(Mugmwm, LeavesGivenParametersAlone) {
  const std::vector<WaveletVariance> moments = {
      theory(model_of("AR1(sigma2=0.01, phi=0.99) + WN(sigma2=1)"), 1U << 16U)};
  for (const Weighting weighting : {Weighting::kDiagonal, Weighting::kFull}) {
    const Model right = mugmwm(model_of("AR1(phi=0.99) + WN"), moments, weighting).model;
    expect_same_values(right, model_of("AR1(sigma2=0.01, phi=0.99) + WN(sigma2=1)"), 1e-6, "right");
    const Model split = mugmwm(model_of("AR1 + WN(sigma2=0.25) + WN"), moments, weighting).model;
    EXPECT_EQ(values(split.terms[1].process)[0], 0.25);
    EXPECT_NEAR(values(split.terms[2].process)[0], 0.75, 1e-6);  // the free one takes what is left
    const Model wrong = mugmwm(model_of("AR1(phi=0.95) + WN"), moments, weighting).model;
    EXPECT_EQ(values(wrong.terms[0].process)[1], 0.95);
    EXPECT_GT(values(wrong.terms[0].process)[0], 0.012);  // a shorter memory needs more power
    const Model all =
        mugmwm(model_of("AR1(sigma2=0.3, phi=0.5) + WN(sigma2=0.9)"), moments, weighting).model;
    EXPECT_EQ(all, model_of("AR1(sigma2=0.3, phi=0.5) + WN(sigma2=0.9)"));
  }
}

TEST(Mugmwm, LargerModelsAreNeverWorse) {
  FIGURES_ALONE();
  constexpr std::uint64_t kSeed = 4100;
  constexpr std::size_t kSets = 100;
  const std::vector<std::string> names = {"WN",          "WN+RW",         "AR1+WN",
                                          "AR1+WN+RW",   "2*AR1+WN",      "2*AR1+WN+RW",
                                          "3*AR1+WN+RW", "QN+2*AR1+WN+RW"};
  const std::vector<std::pair<std::size_t, std::size_t>> nested = {
      {0, 1}, {0, 2}, {1, 3}, {2, 3}, {2, 4}, {3, 5}, {4, 5}, {5, 6}, {5, 7}};
  const std::vector<std::string> truths = {
      "AR1(sigma2=1e-4, phi=0.999) + AR1(sigma2=0.2, phi=0.8) + WN(sigma2=1) + RW(gamma2=1e-8)",
      "RES(sigma2=0.02, r=0.97, omega=0.3) + WN(sigma2=1) + RW(gamma2=1e-6)",
      "QN(q2=3) + FN(b2=0.05) + WN(sigma2=1)"};
  std::vector<std::vector<double>> objective(kSets);
  for_each_index(kSets, [&](std::size_t i) {
    RandomStream rng(kSeed, {static_cast<std::uint32_t>(i)});
    WaveletVariance wv = theory(model_of(truths[i % truths.size()]), 1U << 18U);
    for (double& v : wv.variance) v *= std::exp((i % 2 == 0 ? 0.05 : 0.3) * rng.normal());
    set_chi_square_interval(wv);
    for (const std::string& name : names) {
      objective[i].push_back(
          mugmwm(model_of(name), std::span(&wv, 1), Weighting::kDiagonal).objective);
    }
  });
  int worse = 0;
  for (std::size_t i = 0; i < kSets; ++i) {
    for (const auto& [small, large] : nested) {
      const double ratio = objective[i][large] / objective[i][small] - 1.0;
      if (ratio > 1e-9) {
        ++worse;
        std::printf("set %zu: %s %.12g is worse than %s %.12g by %.2e\n", i, names[large].c_str(),
                    objective[i][large], names[small].c_str(), objective[i][small], ratio);
      }
    }
  }
  EXPECT_EQ(worse, 0) << "seeds from " << kSeed;
}

TEST(Mugmwm, SameBitsForAnyNumberOfThreads) {
  const Model truth = model_of("AR1(sigma2=0.05, phi=0.97) + WN(sigma2=1) + RW(gamma2=1e-4)");
  const auto run = [&] {
    const auto moments = testing::simulated_set(truth, {5000, 4000}, 2, 91);
    return infer(mugmwm(freed(truth), moments, Weighting::kFull), moments);
  };
  const Fit many = run();
  const ThreadLimit limit(1);
  const Fit one = run();
  EXPECT_EQ(many.estimate.model, one.estimate.model);
  EXPECT_EQ(many.estimate.objective, one.estimate.objective);
  EXPECT_EQ(many.goodness.statistic, one.goodness.statistic);
  EXPECT_EQ(many.parameters[0][1].upper, one.parameters[0][1].upper);
}

TEST(Whitening, HoldsBetweenTheOctaves) {
  for (const char* text :
       {"WN(sigma2=1)", "RW(gamma2=1)", "AR1(sigma2=0.05, phi=0.97) + WN(sigma2=1)"}) {
    for (const int per_octave : {1, 2, 4}) {
      const std::vector<WaveletVariance> moments = {theory(model_of(text), 1U << 14U, per_octave)};
      const Eigen::MatrixXd v = moment_covariances(model_of(text), moments)[0];
      const Whitening white = whiten(v);
      std::printf("%-45s %d an octave: condition %.3g, %ld of %ld directions kept\n", text,
                  per_octave, white.condition, static_cast<long>(white.matrix.rows()),
                  static_cast<long>(v.rows()));
      const Eigen::MatrixXd unit = white.matrix * v * white.matrix.transpose();
      EXPECT_LT((unit - Eigen::MatrixXd::Identity(unit.rows(), unit.cols())).cwiseAbs().maxCoeff(),
                1e-5)
          << text;
      EXPECT_LT(white.condition, per_octave == 1 ? 2e3 : 1e10);
      EXPECT_EQ(white.matrix.rows(), v.rows());
    }
  }
}

}  // namespace
}  // namespace imunoise
