// Against the reference numbers: cross-covariances of a simulated array and of real gyros, weights
// of virtual sensors.

#include <gtest/gtest.h>

#include <cmath>

#include "core/array/array_estimate.h"
#include "core/array/virtual_sensor.h"
#include "tests/core/array/published_arrays.h"
#include "tests/support/golden.h"

namespace imunoise {
namespace {

using nlohmann::json;
using testing::read_doubles;
using testing::read_json;

constexpr std::size_t kSensors = 6;

// The array of the reference numbers: row-major samples, one column a sensor.
struct SimulatedArray {
  SimulatedArray() {
    const std::vector<double> rows = read_doubles("golden/array6_65536.f64");
    columns.resize(kSensors);
    for (std::size_t i = 0; i < rows.size(); ++i) columns[i % kSensors].push_back(rows[i]);
    std::vector<Signal> signals;
    for (const auto& column : columns) signals.emplace_back(std::span(column), Hertz{1.0});
    measured = wavelet_covariance(signals, Scales::for_samples(columns[0].size()));
  }
  std::vector<std::vector<double>> columns;
  WaveletCovariance measured;
};

TEST(Golden, CrossCovariancesOfTheSimulatedArray) {
  IMUNOISE_NEEDS("golden/wccv_virtual.json");
  const json golden = read_json("golden/wccv_virtual.json")["sim"];
  const SimulatedArray array;
  const WaveletCovariance& measured = array.measured;
  ASSERT_EQ(measured.scales.size(), golden["J"].get<std::size_t>());
  const json& pairs = golden["wccv_pairs_wvpkg"];    // two of them the peer could not compute:
  const json& local = golden["wccv_local"]["wccv"];  // all of them, a row a scale
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto a = pairs[p]["i"].get<Eigen::Index>() - 1;
    const auto b = pairs[p]["j"].get<Eigen::Index>() - 1;
    for (std::size_t j = 0; j < measured.scales.size(); ++j) {
      const Eigen::MatrixXd& c = measured.covariance[j];
      // Rounding of a sum of products is relative to the products, not to what is left of them.
      EXPECT_NEAR(c(a, b), local[j][p].get<double>(), 1e-12 * std::sqrt(c(a, a) * c(b, b)));
    }
  }
  for (std::size_t i = 0; i < kSensors; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    for (std::size_t j = 0; j < measured.scales.size(); ++j) {
      const double variance = golden["wv"][i]["variance"][j].get<double>();
      EXPECT_NEAR(measured.covariance[j](at, at), variance, 1e-12 * variance);
    }
  }
}

TEST(Golden, WeightsFromMeasuredCovariances) {
  IMUNOISE_NEEDS("golden/wccv_virtual.json");
  const json golden = read_json("golden/wccv_virtual.json")["sim"];
  const SimulatedArray array;
  for (const auto& [name, reference] : golden["weights"].items()) {
    const auto weights = reference["scale_weights"].get<std::vector<double>>();
    const Eigen::VectorXd scale_weights = Eigen::Map<const Eigen::VectorXd>(
        weights.data(), static_cast<Eigen::Index>(weights.size()));
    const Eigen::MatrixXd g = weighted_covariance(array.measured.covariance, scale_weights);
    const VirtualSensor sensor = best_virtual_sensor(g, WeightRule::kUnitGain);
    EXPECT_NEAR(sensor.gain, 1.0, 1e-12);
    for (std::size_t i = 0; i < kSensors; ++i) {
      EXPECT_NEAR(sensor.weights(static_cast<Eigen::Index>(i)), reference["coefs"][i].get<double>(),
                  2e-3)
          << name;  // the peer's optimiser stops early: ours is never worse
    }
    const auto coefs = reference["coefs"].get<std::vector<double>>();
    const Eigen::VectorXd theirs =
        Eigen::Map<const Eigen::VectorXd>(coefs.data(), static_cast<Eigen::Index>(coefs.size()));
    EXPECT_LE(sensor.variance, theirs.dot(g * theirs) * (1.0 + 1e-12)) << name;
  }
}

TEST(Golden, PublishedVirtualSensors) {
  IMUNOISE_NEEDS("golden/reference.json");
  const json golden = read_json("golden/reference.json")["virtual"];
  const Scales scales = Scales::for_samples(10'000'000);
  ASSERT_EQ(scales.size(), 22U);
  for (const testing::PublishedExample& example : testing::published_examples()) {
    const std::vector<Eigen::MatrixXd> gammas = covariance(testing::model_of(example), scales);
    for (const auto& [preset, first, last] :
         {std::tuple{"short_1_3", 0, 3}, {"long_20_22", 19, 22}, {"all_equal", 0, 22}}) {
      const json& reference = golden[example.name + "/" + preset];
      Eigen::VectorXd weights = Eigen::VectorXd::Zero(22);
      weights.segment(first, last - first).setConstant(1.0 / (last - first));
      const Eigen::MatrixXd g = weighted_covariance(gammas, weights);
      for (const auto& [rule, field] : {std::pair{WeightRule::kUnitGain, "weights_sum1"},
                                        {WeightRule::kNonnegative, "weights_nonneg"},
                                        {WeightRule::kUnitLength, "weights_L1"}}) {
        const VirtualSensor sensor = best_virtual_sensor(g, rule);
        for (std::size_t i = 0; i < example.white.size(); ++i) {
          EXPECT_NEAR(sensor.weights(static_cast<Eigen::Index>(i)),
                      reference[field][i].get<double>(), 1e-8)
              << example.name << " " << preset << " " << field;
        }
        if (rule == WeightRule::kUnitLength) {
          EXPECT_NEAR(sensor.gain, reference["gain_L1"].get<double>(), 1e-8);
        }
      }
      const VirtualSensor best = best_virtual_sensor(g, WeightRule::kUnitGain);
      EXPECT_NEAR(best.variance, reference["obj"].get<double>(),
                  1e-9 * reference["obj"].get<double>());
      const Eigen::ArrayXd r = gain_over_mean(gammas, best.weights);
      for (const auto& [level, value] : reference["r_j"].items()) {
        EXPECT_NEAR(r(std::stoi(level) - 1), value.get<double>(), 1e-8 * value.get<double>());
      }
    }
  }
}

TEST(Golden, ModelOfTheSimulatedArray) {
  IMUNOISE_NEEDS("golden/wccv_virtual.json");
  const json golden = read_json("golden/wccv_virtual.json")["sim"];
  const SimulatedArray array;
  const ArrayFit fit = fit_array(parse_array_model("RW[corr] + WN", Hertz{1.0}).value(),
                                 {kSensors, {}}, std::span(&array.measured, 1));
  ASSERT_EQ(fit.parameters.size(), 21U + 6U);
  double squares = 0.0;
  for (const ArrayParameter& parameter : fit.parameters) {
    const auto a = static_cast<std::size_t>(parameter.row);
    const auto b = static_cast<std::size_t>(parameter.column);
    const double truth = parameter.latent == 0 ? golden["true_Q"][a][b].get<double>()
                                               : golden["true_R"][a].get<double>();
    const double z = (parameter.estimate.value - truth) / parameter.estimate.standard_error;
    squares += z * z;
    EXPECT_LT(std::abs(z), 4.5) << parameter.latent << " " << a << " " << b;
  }
  std::printf("sum of squared z over 27 parameters: %.1f\n", squares);
  EXPECT_LT(squares, 27.0 + 5.0 * std::sqrt(2.0 * 27.0 * 3.0));  // correlated: a loose bound
}

}  // namespace
}  // namespace imunoise
