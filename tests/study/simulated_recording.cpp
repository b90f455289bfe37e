#include "tests/study/simulated_recording.h"

#include "core/model/model.h"
#include "tests/recording/simulated_bench.h"

namespace imunoise::testing {
namespace {

constexpr Hertz kRate{100.0};

std::vector<double> values_of(const SimulatedRecording& what, std::size_t channel,
                              std::uint32_t replicate) {
  const std::string& model = what.channels[channel].model;
  if (model.empty()) return std::vector<double>(what.samples, 1.0);
  return simulate(parse_model(model, kRate).value(), what.samples, 1000 * what.seed + channel,
                  replicate);
}

}  // namespace

void record(const SimulatedRecording& what) {
  for (std::uint32_t i = 0; i < what.replicates; ++i) {
    const std::uint32_t k = what.first_replicate + i;
    BenchDevice device;
    device.name = what.device;
    device.serial = what.serial;
    device.rate_hz = kRate.value;
    device.samples = what.samples;
    for (std::size_t c = 0; c < what.channels.size(); ++c) {
      device.channels.push_back({what.channels[c].name, what.channels[c].unit,
                                 [values = values_of(what, c, k)](std::size_t sample, double) {
                                   return values[sample];
                                 }});
    }
    record_bench(what.folder, k, what.started_ns, {device});
  }
}

}  // namespace imunoise::testing
