// Each consumer's own recursion, fed with the file that was written for it, makes noise of the
// Allan deviation of the model: every scale within 4.5 standard deviations by exact theory
// (false-alarm probability below 1e-3 over all tests; seeds are fixed).

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/support/random.h"
#include "core/wavelet/moment_covariance.h"
#include "core/wavelet/wavelet_variance.h"
#include "study/export/known_consumers.h"
#include "tests/study/export/example_imu.h"

namespace imunoise::testing {
namespace {

using study::ExportOptions;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kGravity = 9.80665;

// The noise that a consumer takes a measurement to have: white numbers and a bias, step by step.
struct Recursion {
  double dt = 0.0;                             // s
  std::function<double(RandomStream&)> white;  // of one step
  double phi = 1.0;                            // what remains of the bias after a step
  double walk = 0.0;                           // standard deviation of what it gains
};

Recursion simple(double dt, double white, double walk, double phi = 1.0) {
  return {dt, [=](RandomStream& rng) { return white * rng.normal(); }, phi, walk};
}

// Reads the file as the consumer does, for the first axis of the gyro or the accelerometer.
using Reader = std::function<Recursion(const std::string& file, bool gyro, double rate)>;

double first(const std::string& file, const std::string& key) {
  const std::vector<double> all = numbers_of(file, key);
  EXPECT_FALSE(all.empty()) << key << " is not in\n" << file;
  return all.empty() ? NAN : all.front();
}

double pick(const std::string& file, bool gyro, const char* of_gyro, const char* of_acc) {
  return first(file, gyro ? of_gyro : of_acc);
}

// Kalibr and OpenVINS: noise N/√dt a sample, biases step by K√dt.
Recursion by_densities(const std::string& file, bool gyro, double rate) {
  const double dt = 1.0 / rate;
  return simple(
      dt,
      pick(file, gyro, "gyroscope_noise_density", "accelerometer_noise_density") / std::sqrt(dt),
      pick(file, gyro, "gyroscope_random_walk", "accelerometer_random_walk") * std::sqrt(dt));
}

Recursion by_orb_slam3(const std::string& file, bool gyro, double rate) {
  const double sf = std::sqrt(rate);
  return simple(1.0 / rate, pick(file, gyro, "IMU.NoiseGyro", "IMU.NoiseAcc") * sf,
                pick(file, gyro, "IMU.GyroWalk", "IMU.AccWalk") / sf);
}

Recursion by_basalt(const std::string& file, bool gyro, double) {
  const double rate = first(file, "imu_update_rate\":");
  return simple(1.0 / rate, pick(file, gyro, "gyro_noise_std", "accel_noise_std") * std::sqrt(rate),
                pick(file, gyro, "gyro_bias_std", "accel_bias_std") / std::sqrt(rate));
}

// Preintegration adds cov/dt·dt² to the integral, biasCov·dt to the bias.
Recursion by_gtsam(const std::string& file, bool gyro, double rate) {
  const double dt = 1.0 / rate;
  const double cov = pick(file, gyro, "params.gyroscopeCovariance = gtsam::Vector3",
                          "params.accelerometerCovariance = gtsam::Vector3");
  const double bias = pick(file, gyro, "params.biasOmegaCovariance = gtsam::Vector3",
                           "params.biasAccCovariance = gtsam::Vector3");
  return simple(dt, std::sqrt(cov / dt), std::sqrt(bias * dt));
}

Recursion by_lio_sam(const std::string& file, bool gyro, double rate) {
  const double dt = 1.0 / rate;
  const double cov = std::pow(pick(file, gyro, "imuGyrNoise", "imuAccNoise"), 2);
  return simple(dt, std::sqrt(cov / dt),
                pick(file, gyro, "imuGyrBiasN", "imuAccBiasN") * std::sqrt(dt));
}

// Midpoint integration: the mean of two independent draws a step.
Recursion by_vins(const std::string& file, bool gyro, double rate) {
  const double n = pick(file, gyro, "gyr_n", "acc_n");
  return {1.0 / rate,
          [n](RandomStream& rng) {
            const double begin = n * rng.normal();
            return 0.5 * (begin + n * rng.normal());
          },
          1.0, pick(file, gyro, "gyr_w", "acc_w") / rate};
}

Recursion by_fast_lio(const std::string& file, bool gyro, double rate) {
  return simple(1.0 / rate, std::sqrt(pick(file, gyro, "gyr_cov", "acc_cov")),
                std::sqrt(pick(file, gyro, "b_gyr_cov", "b_acc_cov")) / rate);
}

// EKF2: variance of the angle grows by (dt·noise)² a step, of the bias by (dt·b_noise)².
Recursion by_px4(const std::string& file, bool gyro, double) {
  const double dt = 0.01;
  return simple(dt, pick(file, gyro, "EKF2_GYR_NOISE", "EKF2_ACC_NOISE"),
                dt * pick(file, gyro, "EKF2_GYR_B_NOISE", "EKF2_ACC_B_NOISE"));
}

// EKF3 keeps the bias of the delta angle: it steps by dt²·P_NSE, dt·P_NSE as a rate.
Recursion by_ardupilot(const std::string& file, bool gyro, double) {
  const double dt = 0.012;
  return simple(dt, pick(file, gyro, "EK3_GYRO_P_NSE", "EK3_ACC_P_NSE"),
                dt * dt * pick(file, gyro, "EK3_GBIAS_P_NSE", "EK3_ABIAS_P_NSE") / dt);
}

// An Ornstein-Uhlenbeck process, exactly discretised.
Recursion by_gazebo(const std::string& file, bool gyro, double rate) {
  const std::string group = gyro ? "<angular_velocity>" : "<linear_acceleration>";
  const std::string part = file.substr(file.find(group));
  const double dt = 1.0 / rate;
  const double s = first(part, "<dynamic_bias_stddev");
  const double tau = first(part, "<dynamic_bias_correlation_time");
  return simple(dt, first(part, "<stddev"),
                std::sqrt(-s * s * tau / 2.0 * std::expm1(-2.0 * dt / tau)), std::exp(-dt / tau));
}

Recursion by_airsim(const std::string& file, bool gyro, double rate) {
  const double dt = 1.0 / rate;
  const double arw = gyro ? first(file, "AngularRandomWalk\"") / 60.0 * kDegree
                          : first(file, "VelocityRandomWalk\"") * kGravity / 1e3;
  const double stability = gyro ? first(file, "GyroBiasStability\"") / 3600.0 * kDegree
                                : first(file, "AccelBiasStability\"") * 1e-6 * kGravity;
  const double tau = pick(file, gyro, "GyroBiasStabilityTau\"", "AccelBiasStabilityTau\"");
  return simple(dt, arw / std::sqrt(dt), stability / std::sqrt(tau) * std::sqrt(dt));
}

Recursion by_matlab(const std::string& file, bool gyro, double rate) {
  return simple(1.0 / rate,
                pick(file, gyro, "imu.Gyroscope.NoiseDensity", "imu.Accelerometer.NoiseDensity") *
                    std::sqrt(rate),
                pick(file, gyro, "imu.Gyroscope.RandomWalk", "imu.Accelerometer.RandomWalk") /
                    std::sqrt(rate));
}

// F = -1/τ, Q = 2σ²/τ, first order in dt.
Recursion by_kf_gins(const std::string& file, bool gyro, double rate) {
  const double dt = 1.0 / rate;
  const double density = gyro ? first(file, "arw") * kDegree / 60.0 : first(file, "vrw") / 60.0;
  const double sigma = gyro ? first(file, "gbstd") * kDegree / 3600.0 : first(file, "abstd") * 1e-5;
  const double tau = first(file, "corrtime") * 3600.0;
  return simple(dt, density / std::sqrt(dt), std::sqrt(2.0 * sigma * sigma / tau * dt),
                1.0 - dt / tau);
}

Recursion by_navego(const std::string& file, bool gyro, double rate) {
  const double dt = 1.0 / rate;
  const double density =
      gyro ? first(file, "imu.arw") / 60.0 * kDegree : first(file, "imu.vrw") / 60.0;
  const double dyn =
      gyro ? first(file, "imu.gb_dyn") * kDegree : first(file, "imu.ab_dyn") * 0.001 * kGravity;
  const double corr = pick(file, gyro, "imu.gb_corr", "imu.ab_corr");
  return simple(dt, density / std::sqrt(dt), dyn / std::sqrt(corr) * std::sqrt(dt),
                1.0 - dt / corr);
}

Recursion by_ros(const std::string& file, bool gyro, double rate) {
  return simple(
      1.0 / rate,
      std::sqrt(pick(file, gyro, "angular_velocity_covariance", "linear_acceleration_covariance")),
      0.0);
}

Recursion by_autoware(const std::string& file, bool gyro, double rate) {
  return simple(1.0 / rate, pick(file, gyro, "angular_velocity_stddev_xx", "acceleration_stddev"),
                0.0);
}

struct Proof {
  const char* consumer;
  Reader read;
  bool walks = true;    // it has random walk
  bool markov = false;  // it has Markov processes
};

void PrintTo(const Proof& proof, std::ostream* to) { *to << proof.consumer; }

const std::vector<Proof>& proofs() {
  static const std::vector<Proof> kProofs = {{"kalibr", by_densities},
                                             {"openvins", by_densities},
                                             {"orb-slam3", by_orb_slam3},
                                             {"basalt", by_basalt},
                                             {"gtsam", by_gtsam},
                                             {"lio-sam", by_lio_sam},
                                             {"vins-fusion", by_vins},
                                             {"fast-lio", by_fast_lio},
                                             {"px4", by_px4},
                                             {"ardupilot", by_ardupilot},
                                             {"gazebo", by_gazebo, true, true},
                                             {"airsim", by_airsim},
                                             {"matlab", by_matlab},
                                             {"kf-gins", by_kf_gins, true, true},
                                             {"navego", by_navego, true, true},
                                             {"ros", by_ros, false},
                                             {"autoware", by_autoware, false}};
  return kProofs;
}

constexpr std::size_t kSamples = std::size_t{1} << 19U;

std::vector<double> simulate_consumer(const Recursion& recursion, std::uint64_t seed) {
  RandomStream rng(seed);
  std::vector<double> out(kSamples);
  const double spread = 1.0 - recursion.phi * recursion.phi;
  // A Markov process starts anywhere in its stationary distribution.
  double bias = spread > 1e-4 ? recursion.walk / std::sqrt(spread) * rng.normal() : 0.0;
  for (double& x : out) {
    x = recursion.white(rng) + bias;
    bias = recursion.phi * bias + recursion.walk * rng.normal();
  }
  return out;
}

void expect_noise_of(const Recursion& recursion, const std::string& model, std::uint64_t seed) {
  const std::vector<double> x = simulate_consumer(recursion, seed);
  const Hertz rate{1.0 / recursion.dt};
  // The model has its densities at any rate: the grammar's values are per sample at this one.
  const Model noise = parse_model(model, rate).value();
  const Scales scales = Scales::for_samples(kSamples);
  const WaveletVariance measured = wavelet_variance(Signal(std::span(x), rate), scales);
  const Eigen::ArrayXd expected = variance(noise, scales.half_widths());
  const Eigen::MatrixXd covariance = moment_covariance(sum_covariance(noise), scales, kSamples);
  for (Eigen::Index j = 0; j < expected.size(); ++j) {
    const double sd = std::sqrt(covariance(j, j));
    if (2.0 * std::pow(expected(j) / sd, 2) < 10.0) continue;  // too few degrees of freedom
    EXPECT_LT(std::abs(measured.variance(j) - expected(j)), 4.5 * sd)
        << "scale " << j << ", seed " << seed << ": Allan deviation "
        << std::sqrt(measured.variance(j) / expected(j)) << " times the model's";
  }
}

// Densities N and K as a model per sample.
std::string white_and_walk(double n, double k, double rate) {
  return "WN(sigma2=" + std::to_string(n * n * rate * 1e12) + "e-12)" +
         (k > 0.0 ? " + RW(gamma2=" + std::to_string(k * k / rate * 1e18) + "e-18)" : "");
}

class ConsumerProof : public ::testing::TestWithParam<Proof> {};

constexpr double kSampling = 200.0;
// The walk takes over after 0.3 s, so that both K and N are seen to a few per cent.
constexpr double kGyroN = 2e-4;
constexpr double kGyroK = 1e-3;
constexpr double kAccN = 1.5e-3;
constexpr double kAccK = 8e-3;

std::string file_for(const Proof& proof, const std::string& gyro, const std::string& acc) {
  const auto imu = example_imu(gyro, acc, Hertz{kSampling});
  const auto text = study::export_noise(imu, *study::consumer_called(proof.consumer), {"test", ""},
                                        ExportOptions{});
  EXPECT_TRUE(text) << text.error().message;
  return text.value_or("");
}

TEST_P(ConsumerProof, WhiteNoiseAndRandomWalk) {
  const Proof& proof = GetParam();
  const std::string file = file_for(proof, white_and_walk(kGyroN, kGyroK, kSampling),
                                    white_and_walk(kAccN, kAccK, kSampling));
  SCOPED_TRACE(file);
  for (const bool gyro : {true, false}) {
    const Recursion recursion = proof.read(file, gyro, kSampling);
    const double n = gyro ? kGyroN : kAccN;
    const double k = gyro ? kGyroK : kAccK;
    expect_noise_of(recursion, white_and_walk(n, proof.walks ? k : 0.0, 1.0 / recursion.dt),
                    gyro ? 11 : 12);
  }
}

TEST_P(ConsumerProof, MarkovBias) {
  const Proof& proof = GetParam();
  if (!proof.markov) return;
  const std::string gyro = "WN(sigma2=8e-6) + GM(sigma2=4e-6, tc=1.5)";
  const std::string acc = "WN(sigma2=4.5e-4) + GM(sigma2=2e-4, tc=1.5)";
  const std::string file = file_for(proof, gyro, acc);
  SCOPED_TRACE(file);
  expect_noise_of(proof.read(file, true, kSampling), gyro, 13);
  expect_noise_of(proof.read(file, false, kSampling), acc, 14);
}

INSTANTIATE_TEST_SUITE_P(All, ConsumerProof, ::testing::ValuesIn(proofs()), [](const auto& one) {
  std::string name = one.param.consumer;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(KnownConsumers, EachWithNoiseValuesIsProven) {
  for (const study::Consumer* const one : study::known_consumers()) {
    if (one->fields == nullptr) continue;
    EXPECT_TRUE(std::any_of(proofs().begin(), proofs().end(), [&](const Proof& proof) {
      return proof.consumer == one->name;
    })) << one->name;
  }
}

}  // namespace
}  // namespace imunoise::testing
