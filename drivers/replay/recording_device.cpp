#include "drivers/replay/recording_device.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <utility>

#include "recording/store/manifest/device_folder.h"
#include "recording/store/manifest/manifest.h"

namespace imunoise::replay {
namespace {

constexpr std::size_t kMostRowsAtOnce = 4096;  // samples of a stream

drivers::Channel channel_of(const v1::RecordedChannel& from, const recording::Numbers& numbers) {
  drivers::Channel out;
  out.name = from.name();
  if (!from.units().empty()) out.units = from.units();
  out.type = std::visit(
      []<class Number>(const std::vector<Number>& /*type*/) {
        return drivers::number_type<Number>();
      },
      numbers);
  if (from.has_scale_factor()) out.scale_factor = from.scale_factor();
  if (from.has_add_offset()) out.add_offset = from.add_offset();
  out.long_name = from.long_name();
  return out;
}

// The driver's own flags, and what the recorder found missing.
std::uint32_t flags_of(std::uint32_t stored) {
  const std::uint32_t own = stored & 0xffffU;
  const bool known = (own & (IMUNOISE_SAMPLE_AFTER_GAP | IMUNOISE_SAMPLE_AFTER_RESTART)) != 0;
  const bool lost = (stored & recording::kLostBefore) != 0;
  return lost && !known ? own | IMUNOISE_SAMPLE_AFTER_GAP : own;
}

// The folder that was meant.
Result<recording::DeviceFolder> choose(const RecordingChoice& choice,
                                       const std::vector<recording::DeviceFolder>& folders) {
  std::set<std::string> devices;
  std::set<std::uint32_t> replicates;
  for (const recording::DeviceFolder& folder : folders) {
    devices.insert(folder.device());
    replicates.insert(folder.replicate());
  }
  if (devices.empty()) {
    return fail(fmt::format("{}: no recording of imunoise (it has no replicate-1)", choice.folder));
  }
  if (!choice.device && devices.size() > 1) {
    return fail(fmt::format("{}: holds the devices {}; choose one with device=NAME", choice.folder,
                            fmt::join(devices, ", ")));
  }
  const std::string device = choice.device.value_or(*devices.begin());
  const std::uint32_t replicate = choice.replicate.value_or(*replicates.begin());
  const auto found = std::find_if(folders.begin(), folders.end(), [&](const auto& folder) {
    return folder.device() == device && folder.replicate() == replicate;
  });
  if (found != folders.end()) return *found;
  return fail(fmt::format(
      "{}: no device '{}' in replicate {}; there are the devices {} and the "
      "replicates {}",
      choice.folder, device, replicate, fmt::join(devices, ", "), fmt::join(replicates, ", ")));
}

}  // namespace

Result<recording::DeviceRecording> read_recording(const RecordingChoice& choice) {
  const recording::FileSystem& files = recording::posix_file_system();
  const auto folders = recording::find_device_folders(files, choice.folder);
  if (!folders) return tl::make_unexpected(folders.error());
  const auto where = choose(choice, *folders);
  if (!where) return tl::make_unexpected(where.error());
  const auto manifest = recording::read_manifest(files, choice.folder);
  if (!manifest) return tl::make_unexpected(manifest.error());
  auto out = recording::read_device(files, *where, manifest->value_or(v1::Manifest{}));
  if (out && !out->defects.empty()) {
    return fail(fmt::format("{}: {}", choice.folder, out->defects.front()));
  }
  return out;
}

RecordingDevice::RecordingDevice(recording::DeviceRecording recorded, Pace pace,
                                 const plugin::Host& host)
    : recorded_(std::move(recorded)), timeline_(pace, host), next_(recorded_.streams.size()) {
  if (const auto first = next_stream()) begin_ns_ = recorded_.streams[*first].host_time.front();
}

drivers::DeviceInfo RecordingDevice::describe() {
  drivers::DeviceInfo out;
  for (std::size_t s = 0; s < recorded_.streams.size(); ++s) {
    const v1::RecordedStream& from = recorded_.device.streams(static_cast<int>(s));
    drivers::Stream& stream = out.streams.emplace_back();
    stream.name = from.name();
    stream.nominal_rate_hz = from.rate_hz();
    if (from.counter_modulus() > 0) stream.counter_maximum = from.counter_modulus() - 1;
    for (int c = 0; c < from.channels_size(); ++c) {
      stream.channels.push_back(
          channel_of(from.channels(c), recorded_.streams[s].channels[static_cast<std::size_t>(c)]));
    }
  }
  const auto& metadata = recorded_.device.metadata();
  const auto text = [&](const char* key) {
    const auto found = metadata.find(key);
    return found == metadata.end() ? std::string() : found->second;
  };
  out.product = text("product");
  out.serial = recorded_.device.serial();
  out.firmware = text("firmware");
  return out;
}

// The one whose next sample came first.
std::optional<std::size_t> RecordingDevice::next_stream() const {
  std::optional<std::size_t> out;
  for (std::size_t s = 0; s < next_.size(); ++s) {
    const auto& times = recorded_.streams[s].host_time;
    if (next_[s] == times.size()) continue;
    if (!out || times[next_[s]] < recorded_.streams[*out].host_time[next_[*out]]) out = s;
  }
  return out;
}

void RecordingDevice::read(plugin::Samples& samples, const plugin::Wait& wait) {
  const auto first = next_stream();
  if (!first) return samples.end();
  const auto& times = recorded_.streams[*first].host_time;
  // All that comes until then is delivered together: a group, or the next few thousand samples.
  std::int64_t until_ns = times[std::min(next_[*first] + kMostRowsAtOnce, times.size()) - 1];
  if (!timeline_.at_once()) {
    const Pace& pace = timeline_.pace();
    const auto group = static_cast<std::int64_t>(pace.latency_s * pace.speed * 1e9);
    until_ns = std::min(until_ns, times[next_[*first]] + group);
    if (!wait.until(timeline_.due(static_cast<double>(until_ns - begin_ns_) * 1e-9))) return;
  }
  for (std::size_t s = 0; s < next_.size(); ++s) deliver(s, until_ns, samples);
}

void RecordingDevice::deliver(std::size_t stream, std::int64_t until_ns, plugin::Samples& samples) {
  const recording::Rows& rows = recorded_.streams[stream];
  const std::size_t begin = next_[stream];
  const std::size_t most = std::min(rows.size(), begin + kMostRowsAtOnce);
  std::size_t end = begin;
  while (end < most && rows.host_time[end] <= until_ns) ++end;
  if (end == begin) return;
  plugin::Rows to = samples.add_many(stream, end - begin);
  const auto stamps = to.stamps();
  for (std::size_t i = begin; i < end; ++i) {
    const std::uint64_t counter =
        rows.counter.empty() ? 0 : static_cast<std::uint64_t>(rows.counter[i]);
    stamps[i - begin] = {timeline_.host_time_ns(rows.host_time[i] - begin_ns_), counter, 0,
                         flags_of(rows.flags[i])};
  }
  for (std::size_t c = 0; c < rows.channels.size(); ++c) {
    std::visit(
        [&]<class Number>(const std::vector<Number>& numbers) {
          std::copy(numbers.begin() + static_cast<std::ptrdiff_t>(begin),
                    numbers.begin() + static_cast<std::ptrdiff_t>(end),
                    to.column<Number>(c).begin());
        },
        rows.channels[c]);
  }
  next_[stream] = end;
}

}  // namespace imunoise::replay
