#include "recording/store/reading/replicates.h"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "recording/store/format/layout.h"
#include "recording/store/reading/device_recording.h"
#include "recording/store/reading/places.h"
#include "recording/store/timeline/alignment.h"
#include "recording/store/timeline/gaps.h"

namespace imunoise::recording {
namespace {

// The channels that are named, and those of their device beside them, of their stream first.
std::vector<Wanted> same_device(const Offers& offers, const Place& as,
                                const ImportOptions& options) {
  const auto wanted = [&](const Offer& one) {
    const auto& named = options.channels;
    return beside_them(one, options) ||
           std::find(named.begin(), named.end(), one.name) != named.end();
  };
  std::vector<Wanted> out;
  for (const bool same_stream : {true, false}) {
    for (std::size_t i = 0; i < offers.places.size(); ++i) {
      const Place& place = offers.places[i];
      if (place.device == as.device && (place.stream == as.stream) == same_stream &&
          wanted(offers.names[i]))
        out.push_back({offers.names[i].name, place});
    }
  }
  return out;
}

Result<std::vector<Wanted>> select(const std::string& file, const v1::Manifest& manifest,
                                   const ImportOptions& options) {
  const Offers offers = offers_of(manifest);
  auto out = wanted_of(file, offers, options.channels);
  if (!out) return out;
  if (options.beside) return same_device(offers, out->front().place, options);
  for (const Wanted& one : *out) {
    const Place& first = out->front().place;
    if (one.place.device == first.device && one.place.stream == first.stream) continue;
    return fail(
        fmt::format("{}: {} and {} are of different streams, which have clocks of their own; "
                    "choose channels of one stream with --channel",
                    file, out->front().name, one.name));
  }
  return out;
}

std::uint64_t lost_in(const std::vector<RowGap>& gaps) {
  std::uint64_t out = 0;
  for (const RowGap& gap : gaps) out += gap.lost;
  return out;
}

// By the host's clock, which goes on through gaps.
double samples_between(const Rows& rows, std::size_t from, std::size_t to, Hertz rate) {
  const double ns =
      static_cast<double>(rows.host_time[to]) - static_cast<double>(rows.host_time[from]);
  return 1e-9 * ns * rate.value;
}

class Importer {
 public:
  Importer(const std::filesystem::path& root, const ImportOptions& options,
           std::vector<Wanted> wanted)
      : root_(root), options_(options), wanted_(std::move(wanted)) {}

  Result<void> add(DeviceRecording device) {
    const Place& first = wanted_.front().place;
    const v1::RecordedStream& stream = device.device.streams(first.stream);
    Rows& rows = device.streams[static_cast<std::size_t>(first.stream)];
    const std::vector<RowGap> gaps = find_gaps(stream, rows);
    const std::vector<Part> parts = parts_between(gaps, rows.size());
    const std::string name = replicate_folder(device.where.replicate());
    const std::size_t begin = out_.size();
    const Hertz rate = options_.rate.value_or(Hertz{stream.rate_hz()});
    const std::size_t recording = out_.empty() ? 0 : out_.back().origin.recording + 1;
    std::vector<Part> kept;
    for (const Part& part : parts) {
      const std::size_t each = part.count / options_.split_into;
      for (std::size_t i = 0; i < options_.split_into && each >= kMinimumSamples; ++i) {
        kept.push_back({part.begin + i * each, each});
        const double lies = samples_between(rows, kept.front().begin, kept.back().begin, rate);
        out_.push_back({.name = kept.size() > 1 ? fmt::format("{}#{}", name, kept.size()) : name,
                        .source = root_ / device.where.folder,
                        .rate = rate,
                        .channels = {},
                        .origin = origin_at(recording, lies)});
      }
    }
    if (!kept.empty()) out_[begin].timing = {.gaps = gaps.size(), .lost = lost_in(gaps)};
    for (const Wanted& one : wanted_) {
      const v1::RecordedChannel& channel =
          device.device.streams(one.place.stream).channels(one.place.channel);
      const bool other = one.place.stream != first.stream;
      const auto unit = resolve_unit(root_.string(), one.name, channel.units(), options_);
      if (!unit) return tl::make_unexpected(unit.error());
      Rows& own = device.streams[static_cast<std::size_t>(one.place.stream)];
      Numbers& numbers = own.channels[static_cast<std::size_t>(one.place.channel)];
      const auto samples = std::make_shared<const Samples>(
          other ? Samples(at_times(numbers, own.host_time, rows.host_time))
                : samples_of(std::move(numbers)));
      for (std::size_t i = 0; i < kept.size(); ++i) {
        Channel to = in_si(one.name, channel, *unit, rate);
        to.samples = samples;
        to.begin = kept[i].begin;
        to.count = kept[i].count;
        to.interpolated = other;
        out_[begin + i].channels.push_back(std::move(to));
      }
    }
    return {};
  }

  std::vector<Replicate> take() { return std::move(out_); }

 private:
  const std::filesystem::path& root_;
  const ImportOptions& options_;
  std::vector<Wanted> wanted_;
  std::vector<Replicate> out_;
};

}  // namespace

Result<std::vector<Replicate>> import_recording(const FileSystem& files,
                                                const std::filesystem::path& root,
                                                const ImportOptions& options,
                                                const Progress& progress) {
  const std::string file = root.string();
  const auto manifest = manifest_of(files, root);
  if (!manifest) return tl::make_unexpected(manifest.error());
  auto wanted = select(file, *manifest, options);
  if (!wanted) return tl::make_unexpected(wanted.error());
  const std::string device = wanted->front().place.device;
  Importer importer(root, options, std::move(*wanted));
  const auto folders = find_device_folders(files, root);
  if (!folders) return tl::make_unexpected(folders.error());
  double done = 0.0;
  for (const DeviceFolder& where : *folders) {
    if (progress.stopped()) return fail(fmt::format("{}: the import was stopped", file));
    progress.report(done++ / static_cast<double>(folders->size()));
    if (where.device() != device) continue;
    auto read = read_device(files, where, *manifest);
    if (!read) return tl::make_unexpected(read.error());
    if (!read->defects.empty()) return fail(read->defects.front());
    if (auto added = importer.add(std::move(*read)); !added)
      return tl::make_unexpected(added.error());
  }
  std::vector<Replicate> out = importer.take();
  if (!out.empty()) return out;
  return fail(
      fmt::format("{}: no stretch without a gap has {} samples; imunoise verify shows the gaps",
                  file, kMinimumSamples));
}

}  // namespace imunoise::recording
