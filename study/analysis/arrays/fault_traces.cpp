#include "study/analysis/arrays/fault_traces.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace imunoise::study {
namespace {

constexpr std::size_t kParts = 240;

}  // namespace

void add_traces(const std::vector<Series>& sensors, std::size_t replicate, v1::FaultReport& out) {
  const Signal& first = sensors.front().replicates[replicate];
  const std::size_t samples = first.size();
  const std::size_t part = (samples + kParts - 1) / kParts;
  const auto others = static_cast<double>(sensors.size() - 1);
  std::vector<double> start;  // biases would hide everything else
  for (const Series& one : sensors) start.push_back(one.replicates[replicate].value(0));
  std::vector<v1::ParityTrace*> traces;
  for (const Series& one : sensors) {
    v1::ParityTrace& trace = *out.add_traces();
    trace.set_replicate(one.names[replicate]);
    trace.set_sensor(one.channel);
    trace.set_step_s(static_cast<double>(part) / first.rate().value);
    traces.push_back(&trace);
  }
  std::vector<double> values(sensors.size());
  for (std::size_t t = 0; t < samples; ++t) {
    double sum = 0.0;
    for (std::size_t i = 0; i < sensors.size(); ++i) {
      values[i] = sensors[i].replicates[replicate].value(t) - start[i];
      sum += values[i];
    }
    const int at = static_cast<int>(t / part);
    for (std::size_t i = 0; i < sensors.size(); ++i) {
      const double apart = values[i] - (sum - values[i]) / others;
      v1::ParityTrace& trace = *traces[i];
      if (trace.low_size() == at) {
        trace.add_low(apart);
        trace.add_high(apart);
      }
      trace.set_low(at, std::min(trace.low(at), apart));
      trace.set_high(at, std::max(trace.high(at), apart));
    }
  }
}

double resolution_of(const Series& sensor) {
  double least = std::numeric_limits<double>::infinity();
  for (const Signal& signal : sensor.replicates) {
    for (std::size_t t = 1; t < signal.size(); ++t) {
      const double step = std::abs(signal.value(t) - signal.value(t - 1));
      if (step > 0.0) least = std::min(least, step);
    }
  }
  return std::isfinite(least) ? least : 0.0;
}

}  // namespace imunoise::study
