// Virtual sensors of published structure: predicted gain against what held-out data show, and the
// figures of docs/arrays.md.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>

#include "core/array/array_estimate.h"
#include "core/array/array_moments.h"
#include "core/array/virtual_sensor.h"
#include "core/wavelet/moment_covariance.h"
#include "tests/core/array/gain_figure.h"
#include "tests/core/array/published_arrays.h"
#include "tests/core/array/simulated_array.h"

namespace imunoise {
namespace {

constexpr std::uint64_t kSeed = 20261121;

// Equal weights of scales `first` to `last` among `count`, counted from 1.
Eigen::VectorXd scale_weights(std::size_t count, Eigen::Index first, Eigen::Index last) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count));
  out.segment(first - 1, last - first + 1).setConstant(1.0 / static_cast<double>(last - first + 1));
  return out;
}

Eigen::VectorXd weights_for(const std::vector<Eigen::MatrixXd>& gammas, Eigen::Index first,
                            Eigen::Index last) {
  const Eigen::MatrixXd g = weighted_covariance(gammas, scale_weights(gammas.size(), first, last));
  return best_virtual_sensor(g, WeightRule::kUnitGain).weights;
}

// Relative standard error of a measured gain cᵀΓ̂c / eᵀΓ̂e under the model, to first order.
Eigen::ArrayXd gain_errors(const ArrayModel& model, const Eigen::VectorXd& c, const Scales& scales,
                           std::size_t samples) {
  const Pairs pairs = all_pairs(model.sensors);
  const Eigen::MatrixXd v = array_moment_covariance(model, pairs, scales, samples);
  const std::vector<Eigen::MatrixXd> gammas = covariance(model, scales);
  const Eigen::VectorXd e =
      Eigen::VectorXd::Constant(c.size(), 1.0 / static_cast<double>(c.size()));
  const auto n = static_cast<Eigen::Index>(scales.size());
  Eigen::ArrayXd out(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const Eigen::MatrixXd& gamma = gammas[static_cast<std::size_t>(j)];
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(v.rows());
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      const auto [a, b] = pairs[p];
      const double twice = a == b ? 1.0 : 2.0;
      slope(static_cast<Eigen::Index>(p) * n + j) =
          twice * (c(a) * c(b) / c.dot(gamma * c) - e(a) * e(b) / e.dot(gamma * e));
    }
    out(j) = std::sqrt(slope.dot(v * slope));
  }
  return out;
}

TEST(VirtualSensorStudy, FourMarkovGyros) {
  constexpr std::size_t kSamples = 1'000'000;
  std::printf("seed %llu\n", static_cast<unsigned long long>(kSeed));
  const ArrayModel truth = testing::four_markov_gyros();
  const WaveletCovariance training = testing::simulated_moments(truth, kSamples, kSeed, 0);
  const WaveletCovariance unseen = testing::simulated_moments(truth, kSamples, kSeed, 1);
  ASSERT_EQ(training.scales.size(), 18U);
  const ArrayFit fit = fit_array(parse_array_model("4*AR1[corr]", Hertz{100.0}).value(), {3, {}},
                                 std::span(&training, 1));
  for (std::size_t k = 0; k < 4; ++k) {
    const auto time = [&](const ArrayModel& model) {
      return -0.01 / std::log(values(model.latents[k].term.process)[1]);
    };
    std::printf("correlation time %8.3f s, true %8.3f s\n", time(fit.model), time(sorted(truth)));
  }
  const std::vector<Eigen::MatrixXd> fitted = covariance(fit.model, training.scales);
  const std::vector<Eigen::MatrixXd> exact = covariance(truth, training.scales);
  std::vector<testing::GainPanel> panels;
  for (const auto& [name, first, last] : {std::tuple{"short", 1, 6}, std::tuple{"long", 13, 18}}) {
    const Eigen::VectorXd c = weights_for(fitted, first, last);
    const Eigen::ArrayXd predicted = gain_over_mean(fitted, c);
    const Eigen::ArrayXd measured = gain_over_mean(unseen.covariance, c);
    const Eigen::ArrayXd error = gain_errors(truth, c, training.scales, kSamples);
    std::printf("%s: weights %.4f %.4f %.4f; best %.4f %.4f %.4f\n", name, c(0), c(1), c(2),
                weights_for(exact, first, last)(0), weights_for(exact, first, last)(1),
                weights_for(exact, first, last)(2));
    for (Eigen::Index j = 0; j < predicted.size(); ++j) {
      std::printf("  scale %2d: predicted %.4f, measured %.4f ± %.4f\n", static_cast<int>(j + 1),
                  predicted(j), measured(j), measured(j) * error(j));
      // The fit has an error of the same size as the held-out data's.
      EXPECT_LT(std::abs(std::log(measured(j) / predicted(j))), 4.0 * std::sqrt(2.0) * error(j))
          << name << ", scale " << j + 1;
    }
    // Where it was made for, it beats the mean and each sensor, also on data that it never saw.
    const Eigen::MatrixXd g =
        weighted_covariance(unseen.covariance, scale_weights(18, first, last));
    EXPECT_LT(c.dot(g * c), g.sum() / 9.0) << name;
    EXPECT_LT(c.dot(g * c), g.diagonal().minCoeff()) << name;
    panels.push_back({std::string("weights for ") + name + " times: scales " +
                          std::to_string(first) + " to " + std::to_string(last),
                      {{name, predicted, measured, error}}});
  }
  const char* const figure = "virtual-sensor-4ar1.svg";
  std::ofstream(figure) << testing::gain_figure("Three gyros of four Markov noises each", panels);
  std::printf("drawn in %s\n", figure);
}

TEST(VirtualSensorStudy, PublishedExamplesOnHeldOutData) {
  const Scales scales = Scales::for_samples(10'000'000);
  std::vector<testing::GainPanel> panels;
  for (const testing::PublishedExample& example : testing::published_examples()) {
    const ArrayModel model = testing::model_of(example);
    const std::vector<Eigen::MatrixXd> gammas = covariance(model, scales);
    testing::GainPanel panel{example.title, {}};
    for (const auto& [name, first, last] :
         {std::tuple{"short", 1, 3}, std::tuple{"long", 20, 22}}) {
      const Eigen::VectorXd c = weights_for(gammas, first, last);
      panel.curves.push_back({name, gain_over_mean(gammas, c)});
      // Nothing was fitted here: the published models' gains, as simulated data of theirs show
      // them.
      constexpr std::size_t kSamples = 1 << 18;
      const WaveletCovariance seen = testing::simulated_moments(model, kSamples, kSeed, 2);
      const Eigen::ArrayXd measured = gain_over_mean(seen.covariance, c);
      const Eigen::ArrayXd predicted = gain_over_mean(covariance(model, seen.scales), c);
      const Eigen::ArrayXd error = gain_errors(model, c, seen.scales, kSamples);
      for (Eigen::Index j = 0; j < measured.size(); ++j) {
        EXPECT_LT(std::abs(std::log(measured(j) / predicted(j))), 4.0 * error(j))
            << example.name << " " << name << ", scale " << j + 1;
      }
    }
    panels.push_back(std::move(panel));
  }
  const char* const figure = "virtual-sensor-examples.svg";
  std::ofstream(figure) << testing::gain_figure("The three published virtual sensors", panels);
  std::printf("drawn in %s\n", figure);
}

}  // namespace
}  // namespace imunoise
