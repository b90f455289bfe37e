#include "study/analysis/sound_parts.h"

#include <fmt/format.h>

#include "core/diagnosis/integrity.h"
#include "core/spectrum/cross_power.h"

namespace imunoise::study {
namespace {

recording::Replicate part_of(const recording::Replicate& whole, std::size_t begin,
                             std::size_t count) {
  recording::Replicate out = whole;
  for (recording::Channel& channel : out.channels) {
    channel.begin += begin;
    channel.count = count;
  }
  return out;
}

}  // namespace

SoundParts sound_parts(const std::vector<recording::Replicate>& replicates, std::size_t channel) {
  SoundParts out;
  for (const recording::Replicate& whole : replicates) {
    const Signal signal = whole.channels[channel].signal();
    const std::vector<StuckRun> runs = stuck_runs(signal);
    if (runs.empty()) {
      out.replicates.push_back(whole);
      continue;
    }
    std::vector<recording::Replicate> parts;
    std::size_t begin = 0;
    std::size_t lost = 0;
    const auto keep_until = [&](std::size_t end) {
      if (end - begin >= kFewestSamples) parts.push_back(part_of(whole, begin, end - begin));
    };
    for (const StuckRun& run : runs) {
      keep_until(run.first);
      begin = run.first + run.count;
      lost += run.count;
    }
    keep_until(signal.size());
    for (std::size_t i = 1; i < parts.size(); ++i)
      parts[i].name = fmt::format("{}#{}", whole.name, i + 1);
    out.notes.push_back(
        fmt::format("{}: {} stands still for {} samples in {} places; it is cut there, which "
                    "leaves {} parts, each a replicate.",
                    whole.name, whole.channels[channel].name, lost, runs.size(), parts.size()));
    out.replicates.insert(out.replicates.end(), parts.begin(), parts.end());
  }
  if (out.replicates.empty()) return {replicates, {}};
  return out;
}

}  // namespace imunoise::study
