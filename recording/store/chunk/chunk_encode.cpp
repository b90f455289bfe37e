#include <cassert>

#include "recording/hdf5/attributes.h"
#include "recording/hdf5/dataset.h"
#include "recording/hdf5/memory_file.h"
#include "recording/store/chunk/chunk.h"
#include "recording/store/chunk/chunk_names.h"
#include "recording/store/chunk/number_types.h"
#include "recording/store/format/format_version.h"

namespace imunoise::recording {
namespace {

using namespace chunk_names;

template <class Number>
Hdf5Handle write_numbers(hid_t group, const std::string& name, const std::vector<Number>& values) {
  const Hdf5Types types = hdf5_types<Number>();
  return write_dataset(group, name, types.stored, types.memory, values.data(), values.size());
}

// Refusals that blame `channel`; each a count of rows.
bool write_refusals(hid_t object, const Rows& rows, const std::string& channel) {
  bool good = true;
  for (const Refusal& one : rows.refused) {
    if (one.channel != channel) continue;
    good = good && write_attribute(object, kRefused + std::string(word(one.reason)), one.rows);
  }
  return good;
}

bool write_channel(hid_t group, const v1::RecordedChannel& channel, std::uint64_t order,
                   const Rows& rows) {
  const Hdf5Handle dataset =
      std::visit([&](const auto& values) { return write_numbers(group, channel.name(), values); },
                 rows.channels[order]);
  if (!dataset) return false;
  const hid_t id = dataset.get();
  return write_attribute(id, kOrder, order) &&
         (channel.units().empty() ||
          write_attribute(id, kUnits, std::string_view(channel.units()))) &&
         (channel.long_name().empty() ||
          write_attribute(id, kLongName, std::string_view(channel.long_name()))) &&
         (!channel.has_scale_factor() || write_attribute(id, kScale, channel.scale_factor())) &&
         (!channel.has_add_offset() || write_attribute(id, kOffset, channel.add_offset())) &&
         (!channel.has_valid_min() || write_attribute(id, kValidMin, channel.valid_min())) &&
         (!channel.has_valid_max() || write_attribute(id, kValidMax, channel.valid_max())) &&
         write_refusals(id, rows, channel.name());
}

bool write_stream(hid_t file, const v1::RecordedStream& stream, std::uint64_t order,
                  const Rows& rows) {
  const Hdf5Handle group(
      H5Gcreate2(file, stream.name().c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  if (!group) return false;
  const hid_t id = group.get();
  bool good = write_attribute(id, kOrder, order) && write_attribute(id, kRate, stream.rate_hz()) &&
              write_attribute(id, kModulus, std::uint64_t{stream.counter_modulus()}) &&
              write_attribute(id, kStep, std::uint64_t{stream.counter_step()}) &&
              write_attribute(id, kChannels, std::uint64_t{rows.channels.size()}) &&
              write_attribute(id, kReceived, rows.received) && write_refusals(id, rows, "");
  const Hdf5Handle time = write_numbers(id, kHostTime, rows.host_time);
  good = good && time &&
         write_attribute(time.get(), kUnits, std::string_view("nanoseconds since 1970-01-01")) &&
         write_attribute(time.get(), kLongName, std::string_view("arrival at the host, UTC")) &&
         write_numbers(id, kFlags, rows.flags);
  if (stream.counter_modulus() != 0) good = good && write_numbers(id, kCounter, rows.counter);
  for (int i = 0; i < stream.channels_size(); ++i) {
    good = good && write_channel(id, stream.channels(i), static_cast<std::uint64_t>(i), rows);
  }
  return good;
}

bool write_root(hid_t file, const Chunk& chunk) {
  const v1::RecordedDevice& device = chunk.device;
  bool good = write_attribute(file, kVersion, std::uint64_t{kFormatVersion}) &&
              write_attribute(file, kReplicate, std::uint64_t{chunk.replicate}) &&
              write_attribute(file, kDevice, std::string_view(device.name())) &&
              write_attribute(file, kDriver, std::string_view(device.driver())) &&
              write_attribute(file, kSerial, std::string_view(device.serial())) &&
              write_attribute(file, kFirstSequence, chunk.first_sequence) &&
              write_attribute(file, kLastSequence, chunk.last_sequence) &&
              write_attribute(file, kStreams, std::uint64_t{chunk.streams.size()});
  for (const auto& [key, value] : device.metadata()) {
    good = good && write_attribute(file, kMetadata + key, std::string_view(value));
  }
  return good;
}

}  // namespace

std::uint64_t row_count(const Chunk& chunk) {
  std::uint64_t sum = 0;
  for (const Rows& rows : chunk.streams) sum += rows.size();
  return sum;
}

Result<std::string> encode_chunk(const Chunk& chunk) {
  const QuietHdf5 quiet;
  assert(chunk.streams.size() == static_cast<std::size_t>(chunk.device.streams_size()));
  NewMemoryFile file;
  bool good = file.id() >= 0 && write_root(file.id(), chunk);
  for (int i = 0; i < chunk.device.streams_size(); ++i) {
    const auto order = static_cast<std::uint64_t>(i);
    good = good && write_stream(file.id(), chunk.device.streams(i), order, chunk.streams[order]);
  }
  std::optional<std::string> bytes;
  if (good) bytes = file.finish();
  if (!bytes) return fail("HDF5 cannot build it; free some memory");
  return std::move(*bytes);
}

}  // namespace imunoise::recording
