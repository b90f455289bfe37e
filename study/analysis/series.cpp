#include "study/analysis/series.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/support/nearest_word.h"
#include "recording/import/table/names.h"

namespace imunoise::study {

Series series_of(std::span<const recording::Replicate> replicates, std::size_t channel) {
  Series out;
  const std::vector<recording::Channel>& known = replicates.front().channels;
  out.channel = known[channel].name;
  for (const recording::Replicate& replicate : replicates) out.names.push_back(replicate.name);
  const auto signals = [&](std::size_t c) {
    std::vector<Signal> each;
    for (const recording::Replicate& replicate : replicates)
      each.push_back(replicate.channels[c].signal());
    return each;
  };
  out.replicates = signals(channel);
  for (std::size_t c = 0; c < known.size(); ++c) {
    if (c == channel) continue;
    const Unit& unit = known[c].unit;
    out.beside.push_back(
        {known[c].name, signals(c), unit.quantity == Quantity::kUnknown ? unit.symbol : ""});
  }
  return out;
}

Result<std::size_t> channel_called(const std::string& name, const recording::Replicate& in) {
  const auto& channels = in.channels;
  if (name.empty() && channels.size() == 1) return std::size_t{0};
  auto found = std::find_if(channels.begin(), channels.end(),
                            [&](const recording::Channel& one) { return one.name == name; });
  if (found == channels.end()) {
    found = std::find_if(channels.begin(), channels.end(), [&](const recording::Channel& one) {
      return recording::matches(name, one.name);
    });
  }
  if (found != channels.end()) return static_cast<std::size_t>(found - channels.begin());
  std::string known;
  for (const recording::Channel& one : channels) known += (known.empty() ? "" : ", ") + one.name;
  if (name.empty()) return fail(fmt::format("name one channel with --channel: {}", known));
  std::vector<std::string> names;
  for (const recording::Channel& one : channels) names.push_back(one.name);
  const std::string meant = did_you_mean(name, names);
  return fail(fmt::format("channel '{}': there is none in {}; there are {}{}", name, in.name, known,
                          meant.empty() ? "" : "; " + meant));
}

}  // namespace imunoise::study
