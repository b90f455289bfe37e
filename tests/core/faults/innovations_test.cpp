// The innovations of an array's model: white, whatever the noise is made of.

#include <gtest/gtest.h>

#include <cmath>

#include "core/faults/clusters.h"
#include "core/support/distributions.h"
#include "tests/core/faults/faulty_array.h"
#include "tests/support/figures_alone.h"

namespace imunoise {
namespace {

using testing::array_model;
using testing::coloured_model;
using testing::reading;
using testing::Readings;

constexpr std::uint64_t kInnovationsSeed = 20261121;

TEST(Innovations, ParityDoesNotSeeWhatAllSensorsSee) {
  const Eigen::MatrixXd rows = parity_rows(6, {0, 2, 3, 5});
  ASSERT_EQ(rows.rows(), 3);
  EXPECT_LT((rows * Eigen::VectorXd::Ones(6)).norm(), 1e-14);
  EXPECT_LT((rows * rows.transpose() - Eigen::MatrixXd::Identity(3, 3)).norm(), 1e-14);
  EXPECT_EQ(rows.col(1).norm() + rows.col(4).norm(), 0.0);
}

struct Case {
  const char* text;
  std::vector<double> powers;
};

// At blocks of 1, 8 and 64 samples: unit covariance, nothing left at lags 1 to 8.
TEST(Innovations, AreWhiteForEveryProcess) {
  FIGURES_ALONE();
  constexpr std::size_t kSamples = 1 << 18;
  std::printf("seed %llu\n", static_cast<unsigned long long>(kInnovationsSeed));
  const std::vector<Case> cases = {
      {"WN", {1.0}},
      {"RW[corr] + WN", {0.01, 1.0}},
      {"QN + WN", {1.0, 0.3}},
      {"AR1(phi=0.95)[corr] + WN", {0.1, 1.0}},
      {"AR1(phi=-0.6) + RES(r=0.9, omega=1.2) + WN", {0.5, 0.5, 0.2}},
      {"FN[corr] + WN", {0.5, 1.0}},
      {"MAVG(5) + RW", {1.0, 1e-3}},
      {"DR + WN", {1e-8, 1.0}},
  };
  for (const Case& one : cases) {
    const ArrayModel model = array_model(one.text, 3, one.powers, 0.5);
    const Readings data = testing::simulated_array(model, kSamples, kInnovationsSeed, 0);
    for (const std::int64_t block : {1, 8, 64}) {
      InnovationStream stream(InnovationFilter(model, parity_rows(3, {0, 1, 2}), block));
      const Eigen::MatrixXd rows = parity_rows(3, {0, 1, 2});
      std::vector<Eigen::VectorXd> e;
      Eigen::VectorXd sum = Eigen::VectorXd::Zero(2);
      for (std::size_t t = 0; t < kSamples; ++t) {
        sum += rows * reading(data, t);
        if ((t + 1) % static_cast<std::size_t>(block) != 0) continue;
        if (stream.feed(sum / static_cast<double>(block))) e.push_back(stream.innovation());
        sum.setZero();
      }
      const auto n = static_cast<double>(e.size());
      for (std::size_t lag = 0; lag <= 8; ++lag) {
        Eigen::Matrix2d c = Eigen::Matrix2d::Zero();
        for (std::size_t k = lag; k < e.size(); ++k) c += e[k] * e[k - lag].transpose() / n;
        if (lag == 0) c -= Eigen::Matrix2d::Identity();
        // Five standard errors, and what a history of 32 blocks leaves.
        EXPECT_LT(c.cwiseAbs().maxCoeff(), 5.0 * std::sqrt(2.0 / n) + 0.004)
            << one.text << ", block " << block << ", lag " << lag;
      }
    }
  }
}

TEST(Innovations, StepResponseIsWhatAStepDoes) {
  const ArrayModel model = coloured_model();
  const Eigen::MatrixXd rows = parity_rows(3, {0, 1, 2});
  const InnovationFilter filter(model, rows, 4);
  const Eigen::MatrixXd response = filter.step_response(1, 7);
  InnovationStream stream(filter);
  for (Eigen::Index k = 0; k < InnovationFilter::kHistory + 7; ++k) {
    const bool after = k >= InnovationFilter::kHistory;
    const bool ready = stream.feed(after ? Eigen::VectorXd(rows.col(1)) : Eigen::VectorXd::Zero(2));
    EXPECT_EQ(ready, after);
    if (!after) continue;
    EXPECT_LT((stream.innovation() - response.col(k - InnovationFilter::kHistory)).norm(), 1e-12);
  }
}

TEST(Clusters, OneFilterOfOneSampleHasTheNormalThreshold) {
  for (const double rate : {1e-2, 1e-5, 1e-9}) {
    EXPECT_NEAR(cluster_threshold(Eigen::MatrixXd::Ones(1, 1), 1, rate),
                -normal_quantile(0.5 * rate), 1e-9);
  }
}

// A moving average of seven samples stays beyond a threshold for several: counted against the
// number of separate excursions in white noise.
TEST(Clusters, ThresholdGivesTheRateOfExcursions) {
  constexpr double kRate = 1e-3;
  constexpr int kSamples = 2'000'000;
  const Eigen::MatrixXd filter = Eigen::MatrixXd::Constant(1, 7, 1.0 / std::sqrt(7.0));
  const double h = cluster_threshold(filter, 1, kRate);
  EXPECT_LT(h, -normal_quantile(0.5 * kRate)) << "excursions are fewer than samples beyond";
  RandomStream random(kInnovationsSeed);
  Eigen::VectorXd recent = Eigen::VectorXd::Zero(7);
  int excursions = 0;
  int quiet = 7;
  for (int t = 0; t < kSamples; ++t) {
    recent(t % 7) = random.normal();
    if (std::abs(filter.row(0).dot(recent)) > h) {
      excursions += quiet >= 7 ? 1 : 0;
      quiet = 0;
    } else {
      ++quiet;
    }
  }
  const double expected = kRate * kSamples;
  EXPECT_NEAR(excursions, expected, 4.0 * std::sqrt(expected) + 0.03 * expected);
}

}  // namespace
}  // namespace imunoise
