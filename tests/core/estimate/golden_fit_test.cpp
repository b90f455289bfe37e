// MuGMWM against the best minima known for the real recordings (multi-start search by the peers'
// side).

#include <gtest/gtest.h>

#include "core/estimate/estimators.h"
#include "core/support/parallel.h"
#include "tests/support/golden.h"

namespace imunoise {
namespace {

// The peer's own moments of the six recordings: no need to read the recordings themselves.
std::vector<WaveletVariance> golden_moments(const std::string& axis) {
  const auto golden = testing::read_json("golden/wv_real.json");
  std::vector<WaveletVariance> out;
  for (int k = 1; k <= 6; ++k) {
    const auto& one = golden["data"]["adis_16405_imu" + std::to_string(k)][axis];
    WaveletVariance wv;
    wv.samples = one["N"].get<std::size_t>();
    wv.scales = Scales::for_samples(wv.samples);
    wv.rate = Hertz{100};
    const auto n = static_cast<Eigen::Index>(wv.scales.size());
    wv.variance.resize(n);
    for (Eigen::Index j = 0; j < n; ++j)
      wv.variance(j) = one["variance"][static_cast<std::size_t>(j)].get<double>();
    set_chi_square_interval(wv);
    out.push_back(std::move(wv));
  }
  return out;
}

std::string in_our_grammar(std::string name) {
  for (const char digit : {'2', '3'}) {
    const auto at = name.find(std::string(1, digit) + "AR1");
    if (at != std::string::npos) name.insert(at + 1, "*");
  }
  return name;
}

class GoldenFit : public ::testing::TestWithParam<std::string> {};

TEST_P(GoldenFit, IsNeverWorseThanTheBestMinimumKnown) {
  const std::string axis = GetParam();
  IMUNOISE_NEEDS("golden/mgmwm_" + axis + ".json");
  const std::string spelled = axis == "GyroX" ? "Gyro. X" : "Gyro. Y";
  const std::vector<WaveletVariance> moments = golden_moments(spelled);
  const auto golden = testing::read_json("golden/mgmwm_" + axis + ".json");
  for (const auto& [name, fit] : golden["fits"].items()) {
    const Result<Model> model = parse_model(in_our_grammar(name), Hertz{100});
    ASSERT_TRUE(model) << model.error().message;
    const Estimate estimate = mugmwm(*model, moments, Weighting::kDiagonal);
    const double best = fit["polished"]["obj"].get<double>();
    EXPECT_LE(estimate.objective, best * (1.0 + 1e-6))
        << name << ": " << print_with_values(estimate.model);
    RecordProperty(name, std::to_string(estimate.objective / best - 1.0));
    std::printf("%-20s ours %.9f  best known %.9f  %s\n", name.c_str(), estimate.objective, best,
                print_with_values(estimate.model).c_str());
  }
}

INSTANTIATE_TEST_SUITE_P(Axes, GoldenFit, ::testing::Values("GyroX", "GyroY"));

TEST(GoldenFitDeterminism, SameAnswerForAnyNumberOfThreads) {
  IMUNOISE_NEEDS("golden/wv_real.json");
  const std::vector<WaveletVariance> moments = golden_moments("Gyro. X");
  const Model model = *parse_model("2*AR1 + WN + RW", Hertz{100});
  for (const Weighting weighting : {Weighting::kDiagonal, Weighting::kFull}) {
    const Estimate many = mugmwm(model, moments, weighting);
    const ThreadLimit one(1);
    const Estimate single = mugmwm(model, moments, weighting);
    EXPECT_EQ(many.model, single.model);
    EXPECT_EQ(many.objective, single.objective);
  }
}

}  // namespace
}  // namespace imunoise
