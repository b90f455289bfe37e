#include <fmt/core.h>

#include <map>

#include "core/support/counted.h"
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

// Reads attributes of one object and remembers the first trouble, so that a message can be filled
// field by field.
class Attributes {
 public:
  explicit Attributes(hid_t object) : object_(object) {}

  std::optional<double> number(const char* name) {
    return take(read_number_attribute(object_, name));
  }
  std::string text(const char* name) {
    return take(read_string_attribute(object_, name)).value_or("");
  }
  double required(const char* name) { return needed(name, number(name)); }
  std::uint64_t count(const char* name) {
    return needed(name, take(read_count_attribute(object_, name)));
  }
  // Counts in attributes "refused.REASON".
  void add_refusals_of(const std::string& channel, std::vector<Refusal>& out) {
    for (const std::string& name : attribute_names(object_)) {
      if (!name.starts_with(kRefused)) continue;
      const auto reason =
          refused_from_word(std::string_view(name).substr(std::string_view(kRefused).size()));
      if (!reason && !error_)
        error_ = Error{fmt::format("attribute {} is not a known reason", name)};
      const std::uint64_t rows = count(name.c_str());
      if (reason) out.push_back({*reason, channel, rows});
    }
  }
  const std::optional<Error>& error() const { return error_; }

 private:
  template <class Value>
  Value needed(const char* name, const std::optional<Value>& value) {
    if (!value && !error_) error_ = Error{fmt::format("attribute {} is missing", name)};
    return value.value_or(Value{});
  }
  template <class Value>
  std::optional<Value> take(Result<std::optional<Value>> got) {
    if (got) return std::move(*got);
    if (!error_) error_ = got.error();
    return std::nullopt;
  }

  hid_t object_;
  std::optional<Error> error_;
};

// Names of the objects of one type in a group.
std::vector<std::string> names_in(hid_t group, H5O_type_t type) {
  struct Found {
    H5O_type_t type;
    std::vector<std::string> names;
  } found{type, {}};
  const auto visit = [](hid_t parent, const char* name, const H5L_info_t* link,
                        void* out) -> herr_t {
    auto& wanted = *static_cast<Found*>(out);
    H5O_info_t object = {};
    if (link->type == H5L_TYPE_HARD &&
        H5Oget_info_by_name2(parent, name, &object, H5O_INFO_BASIC, H5P_DEFAULT) >= 0 &&
        object.type == wanted.type) {
      wanted.names.emplace_back(name);
    }
    return 0;
  };
  H5Literate(group, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, visit, &found);
  return found.names;
}

std::string dtype_of(const OpenDataset& dataset) {
  const bool real = dataset.type_class == H5T_FLOAT;
  if (!real && !dataset.has_sign) return "";
  return fmt::format("<{}{}", real ? 'f' : 'i', dataset.width);
}

// Reads numbers whose type and count are known to fit.
template <class Number>
Result<std::vector<Number>> read_numbers(hid_t group, const std::string& name, std::size_t rows) {
  const Result<OpenDataset> dataset = open_dataset(group, name);
  if (!dataset) return tl::make_unexpected(dataset.error());
  if (dataset->size != rows) {
    return fail(fmt::format("dataset {}: has {} where {} has {}", name,
                            counted(dataset->size, "sample"), kHostTime, rows));
  }
  std::vector<Number> out(rows);
  if (!read_dataset(*dataset, hdf5_types<Number>().memory, out.data())) {
    return fail(fmt::format("dataset {}: checksum mismatch", name));
  }
  return out;
}

Result<void> read_channel(hid_t group, const std::string& name, std::size_t rows,
                          v1::RecordedChannel& channel, Rows& out, std::uint64_t& order) {
  const auto trouble = [&](const std::string& what) {
    return fail(fmt::format("dataset {}: {}", name, what));
  };
  const Result<OpenDataset> dataset = open_dataset(group, name);
  if (!dataset) return tl::make_unexpected(dataset.error());
  channel.set_name(name);
  channel.set_dtype(dtype_of(*dataset));
  Attributes attributes(dataset->id.get());
  order = attributes.count(kOrder);
  channel.set_units(attributes.text(kUnits));
  channel.set_long_name(attributes.text(kLongName));
  if (const auto value = attributes.number(kScale)) channel.set_scale_factor(*value);
  if (const auto value = attributes.number(kOffset)) channel.set_add_offset(*value);
  if (const auto value = attributes.number(kValidMin)) channel.set_valid_min(*value);
  if (const auto value = attributes.number(kValidMax)) channel.set_valid_max(*value);
  attributes.add_refusals_of(name, out.refused);
  if (attributes.error()) return trouble(attributes.error()->message);
  std::optional<Numbers> numbers = numbers_of_type(channel.dtype());
  if (!numbers) return trouble("is of no number type that a channel can have");
  auto read = std::visit(
      [&](auto& values) -> Result<void> {
        auto got =
            read_numbers<typename std::decay_t<decltype(values)>::value_type>(group, name, rows);
        if (!got) return tl::make_unexpected(got.error());
        values = std::move(*got);
        return {};
      },
      *numbers);
  if (read) out.channels.push_back(std::move(*numbers));
  return read;
}

// The elements of a message in the order that their "order" attributes state: 0, 1, 2, ...
template <class Message>
struct Ordered {
  Message message;
  Rows rows;  // of a stream; of a channel its one column
};
template <class Message>
using InOrder = std::map<std::uint64_t, Ordered<Message>>;

// HDF5 passes over objects whose header is damaged: only the count shows that one is missing.
template <class Message>
bool is_complete(const InOrder<Message>& elements, std::uint64_t count) {
  return elements.size() == count && (count == 0 || elements.rbegin()->first + 1 == count);
}

Result<void> read_stream(hid_t file, const std::string& name,
                         InOrder<v1::RecordedStream>& streams) {
  const auto trouble = [&](const std::string& what) {
    return fail(fmt::format("stream {}: {}", name, what));
  };
  const Hdf5Handle group(H5Gopen2(file, name.c_str(), H5P_DEFAULT), H5Gclose);
  if (!group) return trouble("cannot be opened; the file is damaged");
  Ordered<v1::RecordedStream> out;
  out.message.set_name(name);
  Attributes attributes(group.get());
  const std::uint64_t order = attributes.count(kOrder);
  out.message.set_rate_hz(attributes.required(kRate));
  out.message.set_counter_modulus(attributes.count(kModulus));
  out.message.set_counter_step(attributes.count(kStep));
  const std::uint64_t channel_count = attributes.count(kChannels);
  out.rows.received = attributes.count(kReceived);
  attributes.add_refusals_of("", out.rows.refused);
  if (attributes.error()) return trouble(attributes.error()->message);

  const Result<OpenDataset> time = open_dataset(group.get(), kHostTime);
  if (!time) return trouble(time.error().message);
  const std::size_t rows = time->size;
  const auto read = [&](const char* dataset, auto& values) -> Result<void> {
    auto got = read_numbers<typename std::decay_t<decltype(values)>::value_type>(group.get(),
                                                                                 dataset, rows);
    if (!got) return trouble(got.error().message);
    values = std::move(*got);
    return {};
  };
  if (auto good = read(kHostTime, out.rows.host_time); !good) return good;
  if (auto good = read(kFlags, out.rows.flags); !good) return good;
  if (out.message.counter_modulus() != 0) {
    if (auto good = read(kCounter, out.rows.counter); !good) return good;
  }
  InOrder<v1::RecordedChannel> channels;
  for (const std::string& dataset : names_in(group.get(), H5O_TYPE_DATASET)) {
    if (dataset == kHostTime || dataset == kFlags || dataset == kCounter) continue;
    Ordered<v1::RecordedChannel> channel;
    std::uint64_t place = 0;
    if (auto good = read_channel(group.get(), dataset, rows, channel.message, channel.rows, place);
        !good) {
      return trouble(good.error().message);
    }
    channels.emplace(place, std::move(channel));
  }
  if (!is_complete(channels, channel_count))
    return trouble("a channel is missing; the file is damaged");
  for (auto& [place, channel] : channels) {
    *out.message.add_channels() = std::move(channel.message);
    out.rows.channels.push_back(std::move(channel.rows.channels.front()));
    add_refusals(out.rows.refused, channel.rows.refused);
  }
  streams.emplace(order, std::move(out));
  return {};
}

Result<void> read_root(hid_t file, Chunk& chunk, std::uint64_t& streams) {
  const auto version = read_count_attribute(file, kVersion);
  if (!version || !*version) return fail("is not a chunk of a recording");
  if (**version != kFormatVersion) return fail(other_version(**version));
  Attributes attributes(file);
  chunk.replicate = static_cast<std::uint32_t>(attributes.count(kReplicate));
  chunk.device.set_name(attributes.text(kDevice));
  chunk.device.set_driver(attributes.text(kDriver));
  chunk.device.set_serial(attributes.text(kSerial));
  chunk.first_sequence = attributes.count(kFirstSequence);
  chunk.last_sequence = attributes.count(kLastSequence);
  streams = attributes.count(kStreams);
  for (const std::string& name : attribute_names(file)) {
    const std::string_view prefix = kMetadata;
    if (!name.starts_with(prefix)) continue;
    (*chunk.device.mutable_metadata())[name.substr(prefix.size())] = attributes.text(name.c_str());
  }
  if (attributes.error()) return fail(attributes.error()->message);
  return {};
}

}  // namespace

bool chunk_of_other_version(std::string_view bytes) {
  const QuietHdf5 quiet;
  const Hdf5Handle file = open_memory_file(bytes);
  if (!file) return false;
  const auto version = read_count_attribute(file.get(), kVersion);
  return version && *version && **version != kFormatVersion;
}

Result<Chunk> decode_chunk(std::string_view bytes) {
  const QuietHdf5 quiet;
  const Hdf5Handle file = open_memory_file(bytes);
  if (!file) return fail("HDF5 cannot open it: truncated or damaged");
  Chunk chunk;
  std::uint64_t stream_count = 0;
  if (auto good = read_root(file.get(), chunk, stream_count); !good)
    return tl::make_unexpected(good.error());
  InOrder<v1::RecordedStream> streams;
  for (const std::string& name : names_in(file.get(), H5O_TYPE_GROUP)) {
    if (auto good = read_stream(file.get(), name, streams); !good) {
      return tl::make_unexpected(good.error());
    }
  }
  if (!is_complete(streams, stream_count)) return fail("a stream is missing; the file is damaged");
  for (auto& [place, stream] : streams) {
    *chunk.device.add_streams() = std::move(stream.message);
    chunk.streams.push_back(std::move(stream.rows));
  }
  if (auto good = check_device(chunk.device); !good) return tl::make_unexpected(good.error());
  for (std::size_t i = 0; i < chunk.streams.size(); ++i) {
    Block whole{i, std::move(chunk.streams[i])};
    if (auto good = check_block(chunk.device, whole); !good) {
      return tl::make_unexpected(good.error());
    }
    chunk.streams[i] = std::move(whole.rows);
  }
  return chunk;
}

}  // namespace imunoise::recording
