// Arrays: cross-covariances, MGMWM with intervals, weights.

#include <benchmark/benchmark.h>

#include <random>
#include <vector>

#include "core/array/array_estimate.h"
#include "core/array/virtual_sensor.h"

namespace imunoise {
namespace {

constexpr Hertz kRate{100};
constexpr std::size_t kSensors = 6;
constexpr std::size_t kSamples = 1'000'000;

const std::vector<std::vector<double>>& sensors() {
  static const std::vector<std::vector<double>> kData = [] {
    std::vector<std::vector<double>> out;
    const Model own = *parse_model("WN(sigma2=1)", kRate);
    const Model walk = *parse_model("RW(gamma2=1e-7)", kRate);
    const std::vector<double> shared = simulate(walk, kSamples, 1, 100);
    for (std::uint32_t i = 0; i < kSensors; ++i) {
      out.push_back(simulate(own, kSamples, 1, i));
      const std::vector<double> drift = simulate(walk, kSamples, 2, i);
      for (std::size_t k = 0; k < kSamples; ++k) out.back()[k] += shared[k] + drift[k];
    }
    return out;
  }();
  return kData;
}

WaveletCovariance measure() {
  std::vector<Signal> signals;
  for (const auto& one : sensors()) signals.emplace_back(std::span<const double>(one), kRate);
  return wavelet_covariance(signals, Scales::for_samples(kSamples));
}

void cross_covariance(benchmark::State& state) {
  sensors();
  for (auto _ : state) benchmark::DoNotOptimize(measure().covariance.data());
}
BENCHMARK(cross_covariance)
    ->Name("array/cross_covariance/6x1e6")
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

void mgmwm_from_arrays(benchmark::State& state, const char* text) {
  const Model model = *parse_array_model(text, kRate);
  sensors();
  for (auto _ : state) {
    const WaveletCovariance measured = measure();
    benchmark::DoNotOptimize(fit_array(model, {kSensors, {}}, std::span(&measured, 1)).objective);
  }
}
BENCHMARK_CAPTURE(mgmwm_from_arrays, walk, "RW[corr] + WN")
    ->Name("array/mgmwm/RW[corr]+WN/6x1e6")
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(mgmwm_from_arrays, markov, "AR1 + RW[corr] + WN")
    ->Name("array/mgmwm/AR1+RW[corr]+WN/6x1e6")
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

void weights(benchmark::State& state, WeightRule rule) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd root(32, 40);
  for (double& x : root.reshaped()) x = normal(random);
  const Eigen::MatrixXd g = root * root.transpose();
  for (auto _ : state) benchmark::DoNotOptimize(best_virtual_sensor(g, rule).variance);
}
BENCHMARK_CAPTURE(weights, gain, WeightRule::kUnitGain)->Name("array/weights/unit-gain/32");
BENCHMARK_CAPTURE(weights, positive, WeightRule::kNonnegative)
    ->Name("array/weights/non-negative/32");
BENCHMARK_CAPTURE(weights, length, WeightRule::kUnitLength)->Name("array/weights/unit-length/32");

}  // namespace
}  // namespace imunoise
