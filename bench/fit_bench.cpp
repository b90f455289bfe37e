// From arrays in memory to parameters with intervals, and the covariance of moments on its own.

#include <benchmark/benchmark.h>

#include <vector>

#include "core/inference/fit.h"
#include "core/wavelet/moment_covariance.h"

namespace imunoise {
namespace {

constexpr Hertz kRate{100};
constexpr std::size_t kSamples = 1'000'000;

// Six replicates of what the fit looks for.
const std::vector<std::vector<double>>& replicates() {
  static const std::vector<std::vector<double>> kReplicates = [] {
    const Model model = *parse_model(
        "WN(sigma2=1) + AR1(sigma2=0.05,phi=0.9) + AR1(sigma2=1e-4,phi=0.999) + "
        "AR1(sigma2=1e-7,phi=0.99998)",
        kRate);
    std::vector<std::vector<double>> out;
    for (std::uint32_t k = 0; k < 6; ++k) out.push_back(simulate(model, kSamples, 1, k));
    return out;
  }();
  return kReplicates;
}

std::vector<WaveletVariance> measure() {
  std::vector<WaveletVariance> out;
  for (const std::vector<double>& x : replicates()) {
    out.push_back(
        wavelet_variance(Signal{std::span<const double>(x), kRate}, Scales::for_samples(x.size())));
  }
  return out;
}

void mugmwm_from_arrays(benchmark::State& state, const char* text, Weighting weighting) {
  const Model model = *parse_model(text, kRate);
  replicates();
  for (auto _ : state) {
    const std::vector<WaveletVariance> measured = measure();
    benchmark::DoNotOptimize(
        infer(mugmwm(model, measured, weighting), measured).goodness.statistic);
  }
}
BENCHMARK_CAPTURE(mugmwm_from_arrays, full, "AR1 + WN + RW", Weighting::kFull)
    ->Name("mugmwm/AR1+WN+RW")
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(mugmwm_from_arrays, full, "3*AR1 + WN", Weighting::kFull)
    ->Name("mugmwm/3*AR1+WN")
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(mugmwm_from_arrays, diag, "AR1 + WN + RW", Weighting::kDiagonal)
    ->Name("mugmwm/AR1+WN+RW/diag")
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(mugmwm_from_arrays, diag, "3*AR1 + WN", Weighting::kDiagonal)
    ->Name("mugmwm/3*AR1+WN/diag")
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

void covariance(benchmark::State& state) {
  const Model model =
      *parse_model("WN(sigma2=1) + AR1(sigma2=1e-4,phi=0.999) + RW(gamma2=1e-9)", kRate);
  const Scales scales = Scales::for_samples(kSamples, static_cast<int>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(moment_covariance(sum_covariance(model), scales, kSamples).sum());
  }
}
BENCHMARK(covariance)
    ->ArgName("per_octave")
    ->Arg(1)
    ->Arg(2)
    ->Arg(4)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace imunoise
