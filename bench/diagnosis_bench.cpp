// Diagnosis of six replicates of a million samples with four witnesses, on two threads as on any
// laptop: one look, and a model that is evaluated as `imunoise study add` does, from samples in
// memory.

#include <benchmark/benchmark.h>

#include <cmath>

#include "core/model/model.h"
#include "study/analysis/diagnose_series.h"
#include "study/analysis/evaluate.h"

namespace imunoise::study {
namespace {

constexpr Hertz kRate{100.0};
constexpr std::size_t kSamples = 1'000'000;
constexpr std::uint32_t kReplicates = 6;

recording::Channel simulated(const std::string& name, const std::string& unit,
                             const std::string& model, std::uint64_t seed, std::uint32_t k) {
  auto samples =
      std::make_shared<recording::Samples>(simulate(*parse_model(model, kRate), kSamples, seed, k));
  return {name, std::move(samples), 0, kSamples, 1.0, 0.0, *parse_unit(unit), kRate};
}

// A gyroscope with a line at 13.7 Hz that no model of it has, and what was recorded beside it.
const std::vector<recording::Replicate>& recordings() {
  static const std::vector<recording::Replicate> all = [] {
    std::vector<recording::Replicate> out;
    for (std::uint32_t k = 0; k < kReplicates; ++k) {
      recording::Replicate one{"run" + std::to_string(k + 1), "", kRate, {}};
      one.channels.push_back(simulated("gyro_x", "rad/s",
                                       "WN(sigma2=2.5e-7) + AR1(sigma2=4e-11, phi=0.998) + "
                                       "RW(gamma2=5e-14)",
                                       1, k));
      auto values = std::get<std::vector<double>>(*one.channels[0].samples);
      for (std::size_t t = 0; t < values.size(); ++t)
        values[t] += 3e-6 * std::sin(2.0 * 3.14159265358979 * 0.137 * static_cast<double>(t) + k);
      one.channels[0].samples = std::make_shared<recording::Samples>(std::move(values));
      one.channels.push_back(simulated("gyro_y", "rad/s", "WN(sigma2=2.5e-7)", 2, k));
      one.channels.push_back(simulated("acc_x", "m/s^2", "WN(sigma2=1e-4)", 3, k));
      one.channels.push_back(
          simulated("temperature", "K", "WN(sigma2=1e-4) + RW(gamma2=1e-8)", 4, k));
      one.channels.push_back(simulated("supply", "V", "WN(sigma2=1e-6)", 5, k));
      out.push_back(std::move(one));
    }
    return out;
  }();
  return all;
}

void diagnose_recording(benchmark::State& state) {
  DiagnoseOptions options;
  options.model = "WN + AR1 + RW";
  recordings();
  for (auto _ : state) {
    const auto report = diagnose_series(recordings(), 0, options);
    if (!report || report->candidates(0).effect() != "line") state.SkipWithError("no line found");
  }
}
BENCHMARK(diagnose_recording)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

// Once the recordings were seen, as every one is that a study holds.
void evaluate_added_line(benchmark::State& state) {
  const auto look = prepare_channel(recordings(), 0, std::vector<std::string>());
  for (auto _ : state) {
    const auto rung = evaluate("WN + AR1 + RW + line(f=13.7)", look->prepared, {});
    if (!rung) state.SkipWithError("not evaluated");
  }
}
BENCHMARK(evaluate_added_line)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(3)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace imunoise::study
