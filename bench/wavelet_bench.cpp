// Wavelet variance: processor time of all threads (and wall time) from an array in memory.

#include <benchmark/benchmark.h>

#include <cstdint>
#include <random>
#include <vector>

#include "core/support/parallel.h"
#include "core/wavelet/prefix_sums.h"
#include "core/wavelet/robust_variance.h"
#include "core/wavelet/wavelet_variance.h"

namespace imunoise {
namespace {

template <class Sample>
const std::vector<Sample>& samples(std::size_t n) {
  static std::vector<Sample> out;
  if (out.size() != n) {
    std::mt19937_64 engine(1);
    std::normal_distribution<double> normal(100.0, 7.0);
    out.resize(n);
    for (Sample& x : out) x = static_cast<Sample>(normal(engine));
  }
  return out;
}

template <class Sample>
void classical(benchmark::State& state) {
  const auto& x = samples<Sample>(static_cast<std::size_t>(state.range(0)));
  const Scales scales = Scales::for_samples(x.size(), static_cast<int>(state.range(1)));
  const Signal signal{std::span<const Sample>(x), Hertz{100}};
  const ThreadLimit threads(static_cast<std::size_t>(state.range(2)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(wavelet_variance(signal, scales).variance.sum());
  }
  state.counters["scales"] = static_cast<double>(scales.size());
}

void sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"samples", "per_octave", "threads"})->Unit(benchmark::kMillisecond);
  b->MeasureProcessCPUTime()->UseRealTime();
  for (const int n : {1'000'000, 10'000'000}) b->Args({n, 1, 1})->Args({n, 1, 2})->Args({n, 4, 2});
}
BENCHMARK(classical<std::int16_t>)->Apply(sizes);
BENCHMARK(classical<std::int32_t>)->Apply(sizes);
BENCHMARK(classical<double>)->Apply(sizes);

void one_read(benchmark::State& state) {
  const auto& x = samples<double>(10'000'000);
  for (auto _ : state) {
    double lanes[16] = {};
    for (std::size_t i = 0; i + 16 <= x.size(); i += 16) {
      for (std::size_t lane = 0; lane < 16; ++lane) lanes[lane] += x[i + lane];
    }
    for (double lane : lanes) benchmark::DoNotOptimize(lane);
  }
}
BENCHMARK(one_read)->Unit(benchmark::kMillisecond);

void robust(benchmark::State& state) {
  const auto& x = samples<double>(1'000'000);
  const Signal signal{std::span<const double>(x), Hertz{100}};
  const Scales scales = Scales::for_samples(x.size());
  for (auto _ : state) {
    const auto wv = robust_wavelet_variance(signal, scales, RobustEfficiency::k60);
    benchmark::DoNotOptimize(wv.variance.sum());
  }
}
BENCHMARK(robust)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace imunoise
