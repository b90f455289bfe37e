// Regression among series that share noise.

#include "core/array/mixed_regression.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/array/huber_regression.h"
#include "core/spectrum/cosine_transform.h"
#include "core/support/linear_algebra.h"
#include "core/support/parallel.h"
#include "tests/core/array/simulated_array.h"

namespace imunoise {
namespace {

constexpr Hertz kMixedRate{1.0};
constexpr Eigen::Index kMixedSamples = 720;

ArrayModel walk_and_white() {
  ArrayModel out =
      expand(parse_array_model("RW(gamma2=0.01)[all] + WN(sigma2=1)", kMixedRate).value(), {3, {}});
  return out;
}

// A slow sine in all series, and a saw of its own in each.
RegressionData some_data(const Eigen::MatrixXd& noise, double slow, double saw) {
  RegressionData out{noise, {noise, noise}, kMixedRate};
  for (Eigen::Index t = 0; t < noise.rows(); ++t) {
    for (Eigen::Index i = 0; i < noise.cols(); ++i) {
      out.regressors[0](t, i) = std::sin(0.02 * static_cast<double>(t));
      out.regressors[1](t, i) = static_cast<double>((t * (i + 2)) % 17);
    }
  }
  out.response = noise + slow * out.regressors[0] + saw * out.regressors[1];
  out.response.col(1).array() += 100.0;  // a constant of its own
  return out;
}

// The transform is orthonormal, so that its bands hold the whole of generalised least squares when
// the noise is what it makes independent.
TEST(BandedRegression, IsGeneralisedLeastSquares) {
  constexpr Eigen::Index kFew = 240;  // no band of more than one coefficient
  const ArrayModel model = walk_and_white();
  const Eigen::MatrixXd noise = simulate(model, kFew, 3, 0);
  const RegressionData data = some_data(noise, 0.7, -0.2);
  const Coefficients found = BandedRegression(data).under(model);
  // Dense: all samples of all series, with a constant a series.
  const Eigen::Index n = 3 * kFew;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(n, 5);
  Eigen::VectorXd y(n);
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index t = 0; t < kFew; ++t) {
      const Eigen::Index row = i * kFew + t;
      y(row) = data.response(t, i);
      x(row, 0) = data.regressors[0](t, i);
      x(row, 1) = data.regressors[1](t, i);
      x(row, 2 + i) = 1.0;
      for (Eigen::Index k = 0; k < 3; ++k) {
        for (Eigen::Index s = 0; s < kFew; ++s)
          covariance(row, k * kFew + s) += 0.01 * static_cast<double>(std::min(s, t) + 1);
      }
    }
  }
  const Eigen::MatrixXd inverse = positive_inverse(covariance).matrix;
  const Eigen::MatrixXd bound = positive_inverse(x.transpose() * inverse * x).matrix;
  const Eigen::VectorXd dense = bound * (x.transpose() * inverse * y);
  for (Eigen::Index j = 0; j < 2; ++j) {
    const double error = std::sqrt(bound(j, j));
    EXPECT_NEAR(found.value(j), dense(j), 1e-8 * error) << j;
    EXPECT_NEAR(std::sqrt(found.covariance(j, j)), error, 1e-8 * error) << j;
  }
}

TEST(BandedRegression, NaiveIsOrdinaryLeastSquares) {
  const RegressionData data = some_data(simulate(walk_and_white(), kMixedSamples, 4, 0), 0.7, -0.2);
  const Coefficients naive = BandedRegression(data).naive();
  const Eigen::VectorXd huge = huber_regression(data);  // close to it on normal samples
  EXPECT_NEAR(naive.value(1), -0.2, 0.1);
  EXPECT_NEAR(huge(1), naive.value(1), 0.05);
}

TEST(HuberRegression, OutliersDoNotDecide) {
  Eigen::MatrixXd noise = simulate(walk_and_white(), kMixedSamples, 5, 0);
  RegressionData data = some_data(noise, 0.0, 1.0);
  for (Eigen::Index t = 0; t < kMixedSamples; t += 17)
    data.response(t, 0) += 1e4;  // where its saw is 0
  EXPECT_GT(std::abs(BandedRegression(data).naive().value(1) - 1.0), 5.0);
  EXPECT_NEAR(huber_regression(data)(1), 1.0, 0.2);
}

TEST(BandedRegression, ResidualsAreWhatIsLeft) {
  const RegressionData data = some_data(simulate(walk_and_white(), kMixedSamples, 6, 0), 0.7, -0.2);
  const Eigen::VectorXd some = Eigen::Vector2d(0.3, 1.7);
  const CrossPower direct = cross_power(data.residual(some), kMixedRate);
  const CrossPower found = BandedRegression(data).residual(some);
  for (std::size_t b = 0; b < direct.power.size(); ++b) {
    EXPECT_LT((found.power[b] - direct.power[b]).norm(), 1e-9 * direct.power[b].norm()) << b;
  }
}

TEST(MixedRegression, FindsWhatWasPutIn) {
  const Model written = parse_array_model("RW[all] + WN", kMixedRate).value();
  const RegressionData data = some_data(simulate(walk_and_white(), kMixedSamples, 7, 0), 4.0, 0.0);
  RegressionOptions options;
  options.bootstraps = 39;
  const MixedRegression found = mixed_regression(written, {3, {}}, data, options);
  EXPECT_NEAR(found.gls[0].value, 4.0, 4.0 * found.gls[0].standard_error);
  EXPECT_EQ(found.gls[0].p_value, 1.0 / 40.0);
  EXPECT_GT(found.gls[1].p_value, 1.0 / 40.0);
  // A walk shared by all and a slow regressor: independent samples promise far too much.
  EXPECT_LT(found.naive[0].standard_error, 0.3 * found.gls[0].standard_error);
  EXPECT_NEAR(found.constants(1) - found.constants(0), 100.0, 1.0);
  for (Eigen::Index i = 0; i < 3; ++i) EXPECT_NEAR(found.explained.row(i).sum(), 1.0, 1e-12);
  EXPECT_GT(found.explained(0, 0), 0.3);
  EXPECT_EQ(found.noise.parameters.size(), 4U);
}

TEST(MixedRegression, SameAnswerWithAnyNumberOfThreads) {
  const Model written = parse_array_model("RW[all] + WN", kMixedRate).value();
  const RegressionData data = some_data(simulate(walk_and_white(), kMixedSamples, 8, 0), 1.0, 0.0);
  RegressionOptions options;
  options.bootstraps = 19;
  const MixedRegression several = mixed_regression(written, {3, {}}, data, options);
  const ThreadLimit one(1);
  const MixedRegression alone = mixed_regression(written, {3, {}}, data, options);
  EXPECT_EQ(several.gls[0].value, alone.gls[0].value);
  EXPECT_EQ(several.robust[0].standard_error, alone.robust[0].standard_error);
}

}  // namespace
}  // namespace imunoise
