#include "study/analysis/prepared_channel.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/spectrum/cross_power.h"
#include "core/support/counted.h"
#include "study/analysis/measure.h"
#include "study/analysis/prepare.h"
#include "study/analysis/series.h"

namespace imunoise::study {
namespace {

std::vector<NamedChannel> only(const WitnessNames& wanted, std::vector<NamedChannel> beside) {
  if (!wanted) return beside;
  std::erase_if(beside, [&](const NamedChannel& one) {
    return std::find(wanted->begin(), wanted->end(), one.name) == wanted->end();
  });
  return beside;
}

}  // namespace

Result<void> check_witnesses(const WitnessNames& witnesses, const recording::Replicate& in) {
  for (const std::string& name : witnesses.value_or(std::vector<std::string>())) {
    const bool exists =
        std::any_of(in.channels.begin(), in.channels.end(),
                    [&](const recording::Channel& one) { return one.name == name; });
    if (!exists) return fail(fmt::format("witness {}: no such channel", name));
  }
  return {};
}

Result<RecordedChannel> prepare_channel(std::vector<recording::Replicate> recorded,
                                        std::size_t channel, const WitnessNames& witnesses,
                                        const Progress& progress) {
  const Series whole = series_of(recorded, channel);
  for (std::size_t k = 0; k < whole.replicates.size(); ++k) {
    if (whole.replicates[k].size() < kFewestSamples)
      return fail(fmt::format("{}: too short, {}", whole.names[k],
                              counted(whole.replicates[k].size(), "sample")));
  }
  if (auto known = check_witnesses(witnesses, recorded.front()); !known)
    return tl::unexpected(known.error());
  RecordedChannel out{
      .recorded = std::move(recorded), .channel = channel, .parts = {}, .prepared = {}};
  out.parts = sound_parts(out.recorded, channel);
  const Series series = series_of(out.parts.replicates, channel);
  auto moments = measure(series, {}, progress.part(0.0, 0.3));
  if (!moments) return tl::unexpected(moments.error());
  if (auto sound = check_replicates(series, *moments); !sound) return tl::unexpected(sound.error());
  out.prepared = {.name = series.channel,
                  .replicates = series.names,
                  .notes = out.parts.notes,
                  .changed = out.parts.changed,
                  .moments = std::move(*moments),
                  .subject = std::make_shared<const Subject>(
                      make_subject(series.replicates, only(witnesses, series.beside),
                                   out.parts.places, progress.part(0.3, 1.0)))};
  if (progress.stopped()) return fail("stopped");  // the subject is then not whole
  return out;
}

}  // namespace imunoise::study
