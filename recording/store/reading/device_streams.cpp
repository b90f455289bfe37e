#include "recording/store/reading/device_streams.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "recording/store/reading/device_recording.h"

namespace imunoise::recording {
namespace {

// A stream that is being read, and where its channels lie.
struct Reading {
  int stream = 0;
  std::vector<int> channels;
  DeviceStream out;
};

const v1::RecordedStream& described(const v1::Manifest& manifest, const Place& place) {
  const auto& devices = manifest.devices();
  return std::find_if(devices.begin(), devices.end(),
                      [&](const auto& one) { return one.name() == place.device; })
      ->streams(place.stream);
}

Result<std::vector<Reading>> readings_of(const std::string& file, const v1::Manifest& manifest,
                                         const std::vector<Wanted>& wanted) {
  std::vector<Reading> out;
  for (const Wanted& one : wanted) {
    const v1::RecordedStream& stream = described(manifest, one.place);
    const v1::RecordedChannel& channel = stream.channels(one.place.channel);
    const auto unit = resolve_unit(file, one.name, channel.units(), {});
    if (!unit) return tl::make_unexpected(unit.error());
    auto to = std::find_if(out.begin(), out.end(), [&](const Reading& known) {
      return known.out.device == one.place.device && known.stream == one.place.stream;
    });
    if (to == out.end()) {
      const Hertz rate{stream.rate_hz()};
      to = out.insert(to,
                      {one.place.stream, {}, {one.place.device, stream.name(), rate, {}, {}, {}}});
    }
    to->channels.push_back(one.place.channel);
    to->out.channels.push_back(in_si(one.name, channel, *unit, to->out.rate));
  }
  return out;
}

void take(DeviceRecording& device, Reading& to) {
  if (!device.defects.empty()) to.out.defect = device.defects.front();
  if (!to.out.defect.empty()) return to.out.replicates.clear();
  Rows& rows = device.streams[static_cast<std::size_t>(to.stream)];
  StreamSamples& samples = to.out.replicates[device.where.replicate()];
  samples.timelines = timelines(device.device.streams(to.stream), rows);
  for (const int channel : to.channels) {
    samples.channels.push_back(std::make_shared<const Samples>(
        samples_of(std::move(rows.channels[static_cast<std::size_t>(channel)]))));
  }
}

}  // namespace

Result<std::vector<DeviceStream>> read_streams(const FileSystem& files,
                                               const std::filesystem::path& root,
                                               const v1::Manifest& manifest,
                                               const std::vector<Wanted>& wanted,
                                               const Progress& progress) {
  auto readings = readings_of(root.string(), manifest, wanted);
  if (!readings) return tl::make_unexpected(readings.error());
  const auto folders = find_device_folders(files, root);
  if (!folders) return tl::make_unexpected(folders.error());
  double done = 0.0;
  for (const DeviceFolder& where : *folders) {
    if (progress.stopped()) return fail(fmt::format("{}: the import was stopped", root.string()));
    progress.report(done++ / static_cast<double>(folders->size()));
    if (std::none_of(readings->begin(), readings->end(),
                     [&](const Reading& one) { return one.out.device == where.device(); }))
      continue;
    auto read = read_device(files, where, manifest);
    if (!read) return tl::make_unexpected(read.error());
    for (Reading& one : *readings) {
      if (one.out.device == where.device()) take(*read, one);
    }
  }
  std::vector<DeviceStream> out;
  for (Reading& one : *readings) out.push_back(std::move(one.out));
  return out;
}

}  // namespace imunoise::recording
