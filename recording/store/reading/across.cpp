#include "recording/store/reading/across.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <utility>

#include "recording/import/import.h"
#include "recording/store/format/layout.h"
#include "recording/store/reading/who_joins.h"

namespace imunoise::recording {
namespace {

constexpr double kOneLength = 0.99;  // of the longest replicate

// A stretch that all share, and where.
struct Stretch {
  std::uint32_t replicate = 0;
  std::string name;
  GridPiece piece;
  Origin origin;
};

// When a row was taken, ns since another time.
double time_of(const std::vector<Timeline>& timelines, std::size_t row, std::int64_t since_ns) {
  const auto after = [](std::size_t at, const Timeline& one) { return at < one.part.begin; };
  const Timeline& in =
      *std::prev(std::upper_bound(timelines.begin() + 1, timelines.end(), row, after));
  return in.time_ns(static_cast<double>(row - in.part.begin), since_ns);
}

std::vector<Stretch> stretches_of(const WhoJoins& who) {
  std::vector<Stretch> out;
  for (const auto& [number, replicate] : who.joined.front().stream->replicates) {
    const std::vector<GridStream> streams = in_replicate(who.joined, number);
    if (streams.empty()) continue;
    const std::string name = replicate_folder(number);
    const std::size_t recording = out.empty() ? 0 : out.back().origin.recording + 1;
    const std::vector<Timeline>& times = streams.front().timelines;
    std::size_t found = 0;
    double began = 0.0;
    for (GridPiece& piece : common_grid(streams, kMinimumSamples)) {
      const double begins =
          time_of(times, piece.picked.front().parts.front().begin, times.front().first_ns);
      if (found == 0) began = begins;
      const Origin origin = origin_at(recording, (begins - began) / piece.period_ns);
      out.push_back({number, ++found > 1 ? fmt::format("{}#{}", name, found) : name,
                     std::move(piece), origin});
    }
  }
  return out;
}

// Two starts never agree to the sample; replicates of one length can be averaged.
void even_out(std::vector<Stretch>& stretches) {
  std::size_t longest = 0;
  for (const Stretch& one : stretches) longest = std::max(longest, one.piece.count);
  const auto nearly = [&](const Stretch& one) {
    return static_cast<double>(one.piece.count) >= kOneLength * static_cast<double>(longest);
  };
  std::size_t shortest = longest;
  for (const Stretch& one : stretches) {
    if (nearly(one)) shortest = std::min(shortest, one.piece.count);
  }
  for (Stretch& one : stretches) {
    if (nearly(one)) shorten(one.piece, shortest);
  }
}

template <class Value>
std::vector<Value> taken(const std::vector<Value>& values, const Picked& picked) {
  std::vector<Value> out;
  for (const Part& part : picked.parts) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(part.begin);
    out.insert(out.end(), begin, begin + static_cast<std::ptrdiff_t>(part.count));
  }
  return out;
}

// Sums, which the channel's scale makes means: those of counts are exact.
template <class Value>
std::vector<double> sums(const std::vector<Value>& values, std::size_t averaged) {
  std::vector<double> out(values.size() / averaged, 0.0);
  for (std::size_t i = 0; i < values.size(); ++i)
    out[i / averaged] += static_cast<double>(values[i]);
  return out;
}

// The channel's samples on the grid.
Channel on_grid(Channel channel, const std::shared_ptr<const Samples>& samples,
                const Picked& picked, std::size_t averaged, Hertz rate) {
  channel.rate = rate;
  if (averaged == 1 && picked.parts.size() == 1) {
    channel.samples = samples;
    channel.begin = picked.parts.front().begin;
    channel.count = picked.parts.front().count;
    return channel;
  }
  channel.samples = std::make_shared<const Samples>(std::visit(
      [&](const auto& values) -> Samples {
        auto kept = taken(values, picked);
        if (averaged == 1) return kept;
        return sums(kept, averaged);
      },
      *samples));
  channel.count = size(*channel.samples);
  channel.scale /= static_cast<double>(averaged);
  return channel;
}

Replicate joined_replicate(const std::filesystem::path& root, const Stretch& stretch,
                           const WhoJoins& who) {
  Replicate out{.name = stretch.name,
                .source = root / replicate_folder(stretch.replicate),
                .rate = who.rate,
                .channels = {},
                .origin = stretch.origin};
  for (std::size_t i = 0; i < who.joined.size(); ++i) {
    const Joining& one = who.joined[i];
    const StreamSamples& samples = one.stream->replicates.at(stretch.replicate);
    for (std::size_t c = 0; c < samples.channels.size(); ++c) {
      out.channels.push_back(on_grid(one.stream->channels[c], samples.channels[c],
                                     stretch.piece.picked[i], one.averaged, who.rate));
    }
  }
  return out;
}

void add_names(const DeviceStream& stream, std::vector<std::string>& to) {
  for (const Channel& one : stream.channels) to.push_back(one.name);
}

Across nothing_of(const WhoJoins& who) {
  Across out;
  for (const Joining& one : who.joined) add_names(*one.stream, out.channels);
  for (const Staying& one : who.left_out) add_names(*one.stream, out.channels);
  return out;
}

Across across_of(const std::filesystem::path& root, const WhoJoins& who,
                 const std::vector<Stretch>& stretches) {
  Across out;
  for (std::size_t i = 0; i < who.joined.size(); ++i) {
    const Joining& one = who.joined[i];
    add_names(*one.stream, out.channels);
    JoinedStream& to = out.streams.emplace_back(
        JoinedStream{one.stream->device, one.stream->stream, one.stream->rate,
                     clock_ppm(*one.stream), seconds_of({one}), one.averaged, 0});
    for (const Stretch& stretch : stretches) to.dropped += stretch.piece.picked[i].dropped;
  }
  for (const Stretch& one : stretches) {
    out.seconds += 1e-9 * static_cast<double>(one.piece.count) * one.piece.period_ns;
    out.replicates.push_back(joined_replicate(root, one, who));
  }
  return out;
}

}  // namespace

Result<std::vector<Across>> import_across(const FileSystem& files,
                                          const std::filesystem::path& root,
                                          const std::vector<std::string>& channels,
                                          const Progress& progress) {
  const auto manifest = manifest_of(files, root);
  if (!manifest) return tl::make_unexpected(manifest.error());
  const auto wanted = wanted_of(root.string(), offers_of(*manifest), channels);
  if (!wanted) return tl::make_unexpected(wanted.error());
  std::set<std::string> devices;
  for (const Wanted& one : *wanted) devices.insert(one.place.device);
  if (devices.size() < 2)
    return fail(root.string() + ": name channels of two devices to compare them");
  const auto streams = read_streams(files, root, *manifest, *wanted, progress);
  if (!streams) return tl::make_unexpected(streams.error());

  std::vector<Across> out;
  for (const WhoJoins& who : who_joins(*streams)) {
    const bool several = devices_of(who.joined) > 1;
    std::vector<Stretch> stretches = several ? stretches_of(who) : std::vector<Stretch>();
    if (several && stretches.empty()) {
      return fail(fmt::format("{}: no stretch that the devices share has {} samples", root.string(),
                              kMinimumSamples));
    }
    even_out(stretches);
    out.push_back(several ? across_of(root, who, stretches) : nothing_of(who));
    for (const Staying& one : who.left_out) {
      out.back().left_out.push_back(
          {one.stream->device, one.stream->stream, "not joined: " + one.reason});
    }
  }
  return out;
}

}  // namespace imunoise::recording
