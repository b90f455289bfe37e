#include "tests/hidden_effects/scoring/replicates.h"

namespace imunoise::hidden {

std::vector<recording::Replicate> to_replicates(const std::vector<Recording>& recordings,
                                                double rate_hz) {
  std::vector<recording::Replicate> out;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    recording::Replicate& replicate = out.emplace_back();
    replicate.name = "replicate-" + std::to_string(r + 1);
    replicate.rate = Hertz{rate_hz};
    for (const Trace& trace : recordings[r].traces) {
      recording::Channel& channel = replicate.channels.emplace_back();
      channel.name = trace.name;
      channel.samples = std::make_shared<const recording::Samples>(trace.values);
      channel.count = trace.values.size();
      channel.unit = parse_unit(trace.unit).value();
      channel.scale = channel.unit.to_si;
      channel.offset = channel.unit.si_offset;
      channel.rate = Hertz{rate_hz};
    }
  }
  return out;
}

}  // namespace imunoise::hidden
