// Laws that hold exactly, whatever the numbers.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/array/array_estimate.h"
#include "core/array/dependence.h"
#include "core/array/sensor_misfit.h"
#include "core/array/virtual_sensor.h"
#include "core/support/parallel.h"
#include "core/wavelet/moment_covariance.h"
#include "core/wavelet/wavelet_variance.h"
#include "tests/core/array/simulated_array.h"
#include "tests/support/figures_alone.h"

namespace imunoise {
namespace {

ArrayModel mixed_model() {
  const Model written =
      parse_array_model("RW[corr] + AR1(phi=0.9)[corr] + RES(r=0.9, omega=0.7)[all] + DR + WN + QN",
                        Hertz{1.0})
          .value();
  ArrayModel model = expand(written, {3, {}});
  std::mt19937_64 random(20261121);
  std::normal_distribution<double> normal;
  for (Latent& latent : model.latents) {
    if (latent.matrix()) {
      const bool ramp = std::holds_alternative<RateRamp>(latent.term.process);
      Eigen::MatrixXd root(3, ramp ? 1 : 3);
      for (double& x : root.reshaped()) x = normal(random);
      latent.power = (ramp ? 1e-4 : 0.02) * root * root.transpose();
    } else {
      latent.set_scalar(0.1 + std::abs(normal(random)));
    }
  }
  return model;
}

// The signal Σ c_i y_i of an array is one signal, whose law follows from the array's.
SumCovariance combined(const ArrayModel& model, const Eigen::VectorXd& c) {
  SumCovariance out;
  for (const Latent& latent : model.latents) {
    out += sum_covariance(latent.term.process).scaled(c.dot(latent.power * c));
  }
  return out;
}

TEST(ArrayMoments, AgreeWithThoseOfAnyCombinationOfTheSensors) {
  const ArrayModel model = mixed_model();
  const Scales scales({1, 2, 3, 8, 32});
  constexpr std::size_t kSamples = 120;
  const Pairs pairs = all_pairs(3);
  const Eigen::MatrixXd v = array_moment_covariance(model, pairs, scales, kSamples);
  EXPECT_TRUE(v.isApprox(v.transpose(), 1e-14));
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 10; ++trial) {
    Eigen::VectorXd c(3);
    for (double& x : c) x = normal(random);
    // ν_c(j) = Σ c_a c_b ν_ab(j)
    Eigen::MatrixXd take = Eigen::MatrixXd::Zero(5, 5 * 6);
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      const auto [a, b] = pairs[p];
      take.middleCols(5 * static_cast<Eigen::Index>(p), 5) =
          (a == b ? 1.0 : 2.0) * c(a) * c(b) * Eigen::MatrixXd::Identity(5, 5);
    }
    const Eigen::MatrixXd direct = moment_covariance(combined(model, c), scales, kSamples);
    const Eigen::MatrixXd through = take * v * take.transpose();
    EXPECT_LT((through - direct).cwiseAbs().maxCoeff(), 1e-8 * direct.cwiseAbs().maxCoeff());
  }
}

TEST(ArrayMoments, ExpectationIsTheCombinedWaveletVariance) {
  const ArrayModel model = mixed_model();
  const Scales scales({1, 2, 3, 8, 32});
  const Eigen::Vector3d c(0.3, -1.2, 0.7);
  const std::vector<Eigen::MatrixXd> gammas = covariance(model, scales);
  Eigen::ArrayXd expected = Eigen::ArrayXd::Zero(5);
  for (const Latent& latent : model.latents) {
    expected += c.dot(latent.power * c) * shape(latent.term.process, scales.half_widths());
  }
  for (Eigen::Index j = 0; j < 5; ++j) {
    EXPECT_NEAR(c.dot(gammas[static_cast<std::size_t>(j)] * c), expected(j), 1e-12 * expected(j));
  }
}

TEST(WaveletCovariance, CountsAndDoublesAgreeForAnyNumberOfThreads) {
  std::mt19937_64 random(3);
  std::uniform_int_distribution<int> count(-2000, 2000);
  std::vector<std::int16_t> counts(5000);
  std::vector<double> values;
  std::vector<double> other;
  for (auto& c : counts) {
    c = static_cast<std::int16_t>(count(random));
    values.push_back(0.5 * c);
    other.push_back(c + count(random));
  }
  const Scales scales = Scales::for_samples(counts.size(), 2);
  const Hertz rate{1.0};
  const Signal as_counts(std::span<const std::int16_t>(counts), rate, Quantity::kUnknown, 0.5);
  const Signal as_values(std::span<const double>(values), rate);
  const Signal second(std::span<const double>(other), rate);
  const auto a = wavelet_covariance(std::vector{as_counts, second}, scales);
  const auto b = wavelet_covariance(std::vector{as_values, second}, scales);
  const WaveletVariance own = wavelet_variance(as_counts, scales);
  const WaveletVariance sum_signal = [&] {
    std::vector<double> sum(values.size());
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = values[i] + other[i];
    return wavelet_variance(Signal(std::span<const double>(sum), rate), scales);
  }();
  const ThreadLimit single(1);
  const auto again = wavelet_covariance(std::vector{as_counts, second}, scales);
  for (std::size_t j = 0; j < scales.size(); ++j) {
    const double size = a.covariance[j].diagonal().maxCoeff();
    EXPECT_LT((a.covariance[j] - b.covariance[j]).cwiseAbs().maxCoeff(), 1e-12 * size);
    EXPECT_EQ(a.covariance[j], again.covariance[j]);
    const auto at = static_cast<Eigen::Index>(j);
    EXPECT_NEAR(a.covariance[j](0, 0), own.variance(at), 1e-13 * size);
    EXPECT_NEAR(a.covariance[j].sum(), sum_signal.variance(at), 1e-12 * size);
  }
}

TEST(Expand, GivesEachSharingItsLatents) {
  const Model written =
      parse_array_model("AR1[all] + AR1[group] + RW[corr] + WN + DR", Hertz{1.0}).value();
  const ArrayModel model = expand(written, {4, {0, 0, 1, 1}});
  std::vector<std::vector<Eigen::Index>> sensors;
  for (const Latent& latent : model.latents) sensors.push_back(latent.sensors);
  const std::vector<Eigen::Index> all = {0, 1, 2, 3};
  EXPECT_EQ(sensors, (std::vector<std::vector<Eigen::Index>>{
                         all, {0, 1}, {2, 3}, all, {0}, {1}, {2}, {3}, all}));
  EXPECT_TRUE(model.latents.back().matrix()) << "ramps of several sensors always correlate";
}

// The measured moments are exactly a model's: the fit must find it, whatever shares what.
TEST(FitArray, FindsTheModelThatItsMomentsComeFrom) {
  const Scales scales = Scales::for_samples(1 << 15, 2);
  for (const char* text : {"RW[corr] + WN", "AR1[corr] + WN", "AR1[all] + AR1[group] + WN",
                           "AR1[all] + RW[corr] + WN + QN"}) {
    const Model written = parse_array_model(text, Hertz{1.0}).value();
    const ArrayLayout layout{4, {0, 0, 1, 1}};
    ArrayModel truth = expand(written, layout);
    std::mt19937_64 random(11);
    std::normal_distribution<double> normal;
    double time = 3000.0;
    for (Latent& latent : truth.latents) {
      if (std::holds_alternative<Ar1>(latent.term.process)) {
        std::vector<double> v = values(latent.term.process);
        v[1] = std::exp(-1.0 / time);
        set_values(latent.term.process, v);
        latent.set_scalar(2.0 / time);
        if (time > 100.0)
          time = 40.0;
        else
          time *= 0.7;
      }
      if (latent.matrix()) {
        Eigen::MatrixXd root(4, 4);
        for (double& x : root.reshaped()) x = normal(random);
        latent.power = 1e-3 * root * root.transpose();
      }
    }
    WaveletCovariance exact{scales, covariance(truth, scales), 1 << 15, Hertz{1.0}};
    const ArrayFit fit = fit_array(written, layout, std::span(&exact, 1));
    EXPECT_LT(fit.objective, 1e-9) << text;
    ASSERT_EQ(fit.model.latents.size(), truth.latents.size());
    for (std::size_t t = 0; t < truth.latents.size(); ++t) {
      const Eigen::MatrixXd& power = truth.latents[t].power;
      EXPECT_LT((fit.model.latents[t].power - power).cwiseAbs().maxCoeff(),
                1e-4 * power.cwiseAbs().maxCoeff())
          << text << ", latent " << t;
    }
  }
}

TEST(FitArray, TakesMoreSensorsThanOneActiveSetHolds) {
  constexpr std::size_t kSensors = 24;  // 72 powers
  const Scales scales = Scales::for_samples(1 << 12);
  const Model written = parse_array_model("RW + WN + QN", Hertz{1.0}).value();
  ArrayModel truth = expand(written, {kSensors, {}});
  for (std::size_t t = 0; t < truth.latents.size(); ++t) {
    const bool walk = std::holds_alternative<RandomWalk>(truth.latents[t].term.process);
    truth.latents[t].set_scalar((walk ? 1e-4 : 1.0) * (1.0 + 0.1 * static_cast<double>(t)));
  }
  const WaveletCovariance exact{scales, covariance(truth, scales), 1 << 12, Hertz{1.0}};
  ArrayOptions own;
  own.cross = false;
  const ArrayFit fit = fit_array(written, {kSensors, {}}, std::span(&exact, 1), own);
  for (std::size_t t = 0; t < truth.latents.size(); ++t) {
    const double power = truth.latents[t].scalar();
    EXPECT_NEAR(fit.model.latents[t].scalar(), power, 1e-6 * power) << t;
  }
}

TEST(FitArray, PowersArePositiveSemidefiniteWhenTheMomentsAreNot) {
  const Scales scales = Scales::for_samples(4096);
  ArrayModel impossible = expand(parse_array_model("RW[corr] + WN", Hertz{1.0}).value(), {2, {}});
  impossible.latents[0].power << 1e-3, 1.4e-3, 1.4e-3, 1e-3;  // correlation 1.4
  WaveletCovariance measured{scales, covariance(impossible, scales), 4096, Hertz{1.0}};
  const ArrayFit fit = fit_array(parse_array_model("RW[corr] + WN", Hertz{1.0}).value(), {2, {}},
                                 std::span(&measured, 1));
  const Eigen::MatrixXd& power = fit.model.latents[0].power;
  const double correlation = power(0, 1) / std::sqrt(power(0, 0) * power(1, 1));
  EXPECT_NEAR(correlation, 1.0, 1e-6);
  for (const ArrayParameter& parameter : fit.parameters) {
    EXPECT_TRUE(std::isfinite(parameter.estimate.value));
  }
}

TEST(Dependence, HoldsItsSizeAndSeesWhatIsShared) {
  FIGURES_ALONE();
  constexpr std::uint64_t kSeed = 20261121;
  std::printf("seed %llu\n", static_cast<unsigned long long>(kSeed));
  const Model written = parse_array_model("RW + WN", Hertz{1.0}).value();
  ArrayModel truth = expand(written, {3, {}});
  for (Latent& latent : truth.latents) {
    const bool walk = std::holds_alternative<RandomWalk>(latent.term.process);
    latent.set_scalar(walk ? 1e-4 : 1.0);
  }
  constexpr int kSets = 400;
  int rejected = 0;
  for (std::uint32_t set = 0; set < kSets; ++set) {
    const WaveletCovariance measured = testing::simulated_moments(truth, 2048, kSeed, set);
    const ArrayFit fit = fit_array(written, {3, {}}, std::span(&measured, 1));
    const auto tests = dependence(fit.model, std::span(&measured, 1));
    rejected += std::any_of(tests.begin(), tests.end(),
                            [](const PairDependence& one) { return one.adjusted_p < 0.05; })
                    ? 1
                    : 0;
  }
  // Families of three: 5 % of the sets at most, within four binomial standard errors.
  const double expected = 0.05 * kSets;
  std::printf("rejected %d of %d families\n", rejected, kSets);
  EXPECT_LT(rejected, expected + 4.0 * std::sqrt(expected));
  EXPECT_GT(rejected, expected - 4.0 * std::sqrt(expected));

  ArrayModel shared = expand(parse_array_model("RW[corr] + WN", Hertz{1.0}).value(), {3, {}});
  shared.latents[0].power = 1e-4 * Eigen::MatrixXd::Identity(3, 3);
  shared.latents[0].power(0, 2) = shared.latents[0].power(2, 0) = 0.9e-4;
  const WaveletCovariance measured = testing::simulated_moments(shared, 1 << 16, kSeed, 1);
  const auto tests = dependence(fit_array(written, {3, {}}, std::span(&measured, 1)).model,
                                std::span(&measured, 1));
  EXPECT_LT(tests[1].adjusted_p, 1e-3);
  EXPECT_EQ(tests[1].pair.a, 0);
  EXPECT_EQ(tests[1].pair.b, 2);
}

TEST(VirtualSensor, WeightsMeetTheOptimalityConditions) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (const Eigen::Index n : {2, 5, 12, 32}) {
    Eigen::MatrixXd root(n, n + 2);
    for (double& x : root.reshaped()) x = normal(random);
    const Eigen::MatrixXd g = 1e-9 * root * root.transpose();
    const VirtualSensor free = best_virtual_sensor(g, WeightRule::kUnitGain);
    const Eigen::VectorXd slope = g * free.weights;  // all equal at the optimum
    EXPECT_LT((slope.array() - free.variance).abs().maxCoeff(), 1e-9 * free.variance) << n;
    const VirtualSensor positive = best_virtual_sensor(g, WeightRule::kNonnegative);
    EXPECT_NEAR(positive.gain, 1.0, 1e-12);
    const Eigen::VectorXd along = g * positive.weights;
    for (Eigen::Index i = 0; i < n; ++i) {
      EXPECT_GE(positive.weights(i), 0.0);
      const double excess = along(i) / positive.variance - 1.0;
      EXPECT_GT(excess, -1e-9);
      if (positive.weights(i) > 0.0) {
        EXPECT_LT(excess, 1e-9);
      }
    }
    const VirtualSensor length = best_virtual_sensor(g, WeightRule::kUnitLength);
    EXPECT_NEAR(length.weights.cwiseAbs().sum(), 1.0, 1e-12);
    EXPECT_LE(length.variance, positive.variance * (1.0 + 1e-12));
    EXPECT_GE(length.gain, 0.0);
  }
}

// Of a singular matrix: two sensors whose noise is opposite cancel, one without noise suffices, and
// copies share their weight.
TEST(VirtualSensor, TakesWhatASingularMatrixAllows) {
  const Eigen::Vector3d opposite(1.0, -1.0, 0.5);
  Eigen::MatrixXd cancels = 1e-9 * opposite * opposite.transpose();
  cancels(2, 2) += 1e-9;
  Eigen::MatrixXd quiet = Eigen::Vector3d(1e-9, 0.0, 4e-9).asDiagonal();
  const Eigen::Vector3d copy(1.0, 1.0, 0.0);
  Eigen::MatrixXd copies = 1e-9 * copy * copy.transpose();
  copies(2, 2) = 1e-9;
  for (const WeightRule rule : {WeightRule::kUnitGain, WeightRule::kNonnegative}) {
    const VirtualSensor of_cancelling = best_virtual_sensor(cancels, rule);
    EXPECT_NEAR(of_cancelling.gain, 1.0, 1e-9);
    EXPECT_LT(of_cancelling.variance, 1e-18);
    EXPECT_LT((best_virtual_sensor(quiet, rule).weights - Eigen::Vector3d::Unit(1)).norm(), 1e-9);
    EXPECT_NEAR(best_virtual_sensor(copies, rule).variance, 0.5e-9, 1e-18);
  }
  EXPECT_LT((best_virtual_sensor(copies, WeightRule::kUnitGain).weights -
             Eigen::Vector3d(0.25, 0.25, 0.5))
                .norm(),
            1e-9);
}

// Under a wrong model independent sensors seem to share noise. The misfit of each says that such a
// verdict means nothing; under the right one it is silent.
TEST(SensorMisfit, SaysWhereAVerdictOfSharedNoiseMeansNothing) {
  FIGURES_ALONE();
  const Model right = parse_array_model("AR1 + WN", Hertz{1.0}).value();
  ArrayModel truth = expand(right, {3, {}});
  for (Latent& latent : truth.latents) {
    const bool markov = std::holds_alternative<Ar1>(latent.term.process);
    if (markov) latent.term.process = Ar1{1.0, 0.99};
    latent.set_scalar(markov ? 1e-3 : 1.0);
  }
  const Model wrong = parse_array_model("WN", Hertz{1.0}).value();
  constexpr std::uint32_t kSets = 60;
  int named = 0;
  int judged = 0;
  int misfits = 0;
  for (std::uint32_t set = 0; set < kSets; ++set) {
    const WaveletCovariance measured = testing::simulated_moments(truth, 4096, 20261125, set);
    const auto fits = [&](const Model& model) {
      const ArrayFit fit = fit_array(model, {3, {}}, std::span(&measured, 1));
      const std::vector<TestOutcome> tests = sensor_misfits(fit.model, std::span(&measured, 1));
      return std::pair(fit, tests);
    };
    const auto [fit, tests] = fits(wrong);
    for (const PairDependence& one : dependence(fit.model, std::span(&measured, 1))) {
      if (!(one.adjusted_p < 0.05)) continue;
      ++named;
      const bool good = tests[static_cast<std::size_t>(one.pair.a)].p_value > 0.05 / 3.0 &&
                        tests[static_cast<std::size_t>(one.pair.b)].p_value > 0.05 / 3.0;
      judged += good ? 1 : 0;
    }
    for (const TestOutcome& one : fits(right).second) misfits += one.p_value < 0.05 / 3.0 ? 1 : 0;
  }
  std::printf("%d pairs named in %u sets, %d of them judged\n", named, kSets, judged);
  EXPECT_GT(named, 20);
  EXPECT_EQ(judged, 0);
  EXPECT_LE(misfits, 10);  // of 180 at 1.7 %: P(more) < 0.001
}

// A cross-covariance at one averaging time is the same quantity in replicates of all lengths.
TEST(Dependence, UsesReplicatesOfAllLengths) {
  const auto model_of = [](const char* text) {
    return expand(parse_array_model(text, Hertz{1.0}).value(), {2, {}});
  };
  ArrayModel apart = model_of("WN(sigma2=1) + RW(gamma2=1e-4)");
  ArrayModel shared = model_of("WN[corr] + RW(gamma2=1e-4)");
  shared.latents.front().power << 1.0, 0.1, 0.1, 1.0;
  int alarms = 0;
  int seen = 0;
  constexpr std::uint32_t kSets = 100;
  for (std::uint32_t set = 0; set < kSets; ++set) {
    const auto p_value = [&](const ArrayModel& longer) {
      const std::vector<WaveletCovariance> both{
          testing::simulated_moments(apart, 512, 20261124, 2 * set),
          testing::simulated_moments(longer, 4096, 20261124, 2 * set + 1)};
      return dependence(apart, both).front().test.p_value;
    };
    alarms += p_value(apart) < 0.05 ? 1 : 0;
    seen += p_value(shared) < 0.05 ? 1 : 0;
  }
  EXPECT_LE(alarms, 13);  // P(more than 13 of 100 at 5 %) < 0.001
  EXPECT_GE(seen, 95);    // white correlation 0.1 in 4,096 samples: 6 standard deviations
}

TEST(VirtualSensor, WeightErrorsAgreeWithFiniteDifferences) {
  const Scales scales({1, 4, 16});
  const ArrayModel model = mixed_model();
  const std::vector<Eigen::MatrixXd> gammas = covariance(model, scales);
  const Eigen::Vector3d preset(0.2, 0.5, 0.3);
  const Eigen::MatrixXd g = weighted_covariance(gammas, preset);
  const VirtualSensor best = best_virtual_sensor(g, WeightRule::kUnitGain);
  const Pairs pairs = all_pairs(3);
  const Eigen::Index n = 3 * static_cast<Eigen::Index>(pairs.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    const double step = 1e-6 * g.cwiseAbs().maxCoeff();
    const auto moved = [&](double by) {
      std::vector<Eigen::MatrixXd> other = gammas;
      const auto [a, b] = pairs[static_cast<std::size_t>(i / 3)];
      Eigen::MatrixXd& at = other[static_cast<std::size_t>(i % 3)];
      at(a, b) += by;
      if (a != b) at(b, a) += by;
      return best_virtual_sensor(weighted_covariance(other, preset), WeightRule::kUnitGain).weights;
    };
    const Eigen::VectorXd slope = (moved(step) - moved(-step)) / (2.0 * step);
    Eigen::MatrixXd only = Eigen::MatrixXd::Zero(n, n);
    only(i, i) = 1.0;
    const Eigen::MatrixXd c = weight_covariance(best, g, preset, only);
    EXPECT_LT((c - slope * slope.transpose()).cwiseAbs().maxCoeff(),
              1e-5 * std::max(1.0, slope.squaredNorm()));
  }
}

}  // namespace
}  // namespace imunoise
