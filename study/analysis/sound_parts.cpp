#include "study/analysis/sound_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

#include "core/integrity/integrity.h"
#include "core/integrity/mend.h"
#include "core/spectrum/cross_power.h"
#include "core/support/counted.h"
#include "core/support/parallel.h"

namespace imunoise::study {
namespace {

using recording::Replicate;

Replicate part_of(const Replicate& whole, std::size_t begin, std::size_t count) {
  Replicate out = whole;
  for (recording::Channel& channel : out.channels) {
    channel.begin += begin;
    channel.count = count;
  }
  return out;
}

// Where the parts of replicates lie, in order. What begins before the last part ends is of another
// recording.
class Places {
 public:
  Part of(const Replicate& whole, std::size_t begin, std::size_t count) {
    const std::size_t first = whole.origin.first + begin;
    if (ends_ > 0 && (recording_ != whole.origin.recording || first < ends_)) ++recorded_;
    recording_ = whole.origin.recording;
    ends_ = first + count;
    return {recorded_, static_cast<Eigen::Index>(first)};
  }

 private:
  std::size_t recording_ = 0;
  std::size_t ends_ = 0;
  std::size_t recorded_ = 0;
};

std::vector<Part> uncut(const std::vector<Replicate>& replicates) {
  std::vector<Part> out;
  Places places;
  for (const Replicate& one : replicates)
    out.push_back(places.of(one, 0, one.channels.front().count));
  return out;
}

// Cuts a replicate.
void cut(const Replicate& whole, Places& places, std::size_t channel,
         const std::vector<StuckRun>& runs, SoundParts& to) {
  if (runs.empty()) {
    to.replicates.push_back(whole);
    to.places.push_back(places.of(whole, 0, whole.channels[channel].count));
    return;
  }
  std::vector<Replicate> parts;
  std::size_t begin = 0;
  std::size_t lost = 0;
  const auto keep_until = [&](std::size_t end) {
    if (end - begin < kFewestSamples) return;
    parts.push_back(part_of(whole, begin, end - begin));
    to.places.push_back(places.of(whole, begin, end - begin));
  };
  for (const StuckRun& run : runs) {
    keep_until(run.first);
    begin = run.first + run.count;
    lost += run.count;
  }
  keep_until(whole.channels[channel].count);
  for (std::size_t i = 1; i < parts.size(); ++i)
    parts[i].name = fmt::format("{}#{}", whole.name, i + 1);
  to.notes.push_back(fmt::format(
      "{}: {} repeats its value for {} in {}; the replicate is cut there, which leaves {}.",
      whole.name, whole.channels[channel].name, counted(lost, "sample"),
      counted(runs.size(), "place"), counted(parts.size(), "part")));
  to.replicates.insert(to.replicates.end(), parts.begin(), parts.end());
  to.changed = true;
}

std::vector<WrongSample> wrong_samples(const Signal& signal) {
  std::vector<WrongSample> out;
  for (const Defect& defect : integrity(signal))
    out.insert(out.end(), defect.wrong.begin(), defect.wrong.end());
  // A sample that was cut off and repeats itself is both, and known best as the former.
  std::sort(out.begin(), out.end(), [](const WrongSample& a, const WrongSample& b) {
    return a.at != b.at ? a.at < b.at : std::abs(a.beyond) > std::abs(b.beyond);
  });
  const auto same = [](const WrongSample& a, const WrongSample& b) { return a.at == b.at; };
  out.erase(std::unique(out.begin(), out.end(), same), out.end());
  return out;
}

void mend(Replicate& replicate, std::size_t channel, const std::vector<WrongSample>& wrong,
          SoundParts& to) {
  if (wrong.empty()) return;
  constexpr double kMost = 0.02;  // of the samples
  recording::Channel& of = replicate.channels[channel];
  const Signal signal = of.signal();
  const bool few = static_cast<double>(wrong.size()) <= kMost * static_cast<double>(signal.size());
  to.notes.push_back(fmt::format(
      "{}: {} samples of {} are repeated, clipped or placeholders; {}", replicate.name,
      wrong.size(), of.name,
      few ? "each is replaced by a draw conditional on its neighbours, which keeps the spectrum."
          : "they are too many to replace."));
  if (!few) return;
  to.changed = true;
  of.samples = std::make_shared<const recording::Samples>(mended(signal, wrong));
  of.begin = 0;
  of.scale = 1.0;
  of.offset = 0.0;
}

}  // namespace

SoundParts sound_parts(const std::vector<Replicate>& replicates, std::size_t channel) {
  SoundParts out;
  std::vector<std::vector<StuckRun>> runs(replicates.size());
  for_each_index(replicates.size(), [&](std::size_t k) {
    runs[k] = stuck_runs(replicates[k].channels[channel].signal());
  });
  Places places;
  for (std::size_t k = 0; k < replicates.size(); ++k)
    cut(replicates[k], places, channel, runs[k], out);
  if (out.replicates.empty()) out = {replicates, uncut(replicates), {}, false};
  std::vector<std::vector<WrongSample>> wrong(out.replicates.size());
  for_each_index(wrong.size(), [&](std::size_t k) {
    wrong[k] = wrong_samples(out.replicates[k].channels[channel].signal());
  });
  for (std::size_t k = 0; k < wrong.size(); ++k) mend(out.replicates[k], channel, wrong[k], out);
  return out;
}

}  // namespace imunoise::study
