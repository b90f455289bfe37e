#include "recording/import/ros/imu_messages.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "recording/import/table/bytes.h"
#include "recording/import/table/names.h"

namespace imunoise::recording {
namespace {

constexpr std::array<std::string_view, 6> kNames = {"gyro_x", "gyro_y", "gyro_z",
                                                    "acc_x",  "acc_y",  "acc_z"};
constexpr std::size_t kMostTopics = 4096;

template <class Number>
Number swapped(Number value) {
  std::array<char, sizeof(Number)> raw;
  std::memcpy(raw.data(), &value, sizeof value);
  std::reverse(raw.begin(), raw.end());
  std::memcpy(&value, raw.data(), sizeof value);
  return value;
}

// The time, and where the 37 numbers begin.
struct ImuFrame {
  std::int64_t stamp = 0;
  Fields numbers{{}};
  bool swap = false;
};

ImuFrame ros1_frame(std::string_view bytes) {
  Fields fields(bytes);
  fields.number<std::uint32_t>();  // sequence
  const std::int64_t seconds = fields.number<std::uint32_t>();
  const std::int64_t nanoseconds = fields.number<std::uint32_t>();
  fields.counted<std::uint32_t>();  // frame_id
  return {seconds * 1'000'000'000 + nanoseconds, fields};
}

std::optional<ImuFrame> cdr_frame(std::string_view bytes) {
  Fields fields(bytes);
  const std::string_view kind = fields.bytes(4);
  if (!fields.ok() || kind[0] != 0 || (kind[1] != 0 && kind[1] != 1)) return std::nullopt;
  const bool swap = kind[1] == 0;
  const std::string_view body = fields.rest();
  const auto word = [&] {
    const auto value = fields.number<std::uint32_t>();
    return swap ? swapped(value) : value;
  };
  const std::int64_t seconds = static_cast<std::int32_t>(word());
  const std::int64_t nanoseconds = word();
  fields.bytes(word());  // frame_id
  const std::size_t used = body.size() - fields.rest().size();
  fields.bytes((8 - used % 8) % 8);
  return ImuFrame{seconds * 1'000'000'000 + nanoseconds, fields, swap};
}

// Zeros before a row.
void fill(std::size_t rows, Blocks<double>& values) {
  while (values.size() < rows) values.push(0.0);
}

}  // namespace

bool is_imu_type(std::string_view type) {
  return type == "sensor_msgs/Imu" || type == "sensor_msgs/msg/Imu";
}

std::optional<ImuMessage> decode_imu(Encoding encoding, std::string_view bytes) {
  std::optional<ImuFrame> frame;
  if (encoding == Encoding::kCdr) {
    frame = cdr_frame(bytes);
  } else {
    frame = ros1_frame(bytes);
  }
  if (!frame) return std::nullopt;
  std::array<double, 37> numbers;
  for (double& number : numbers) {
    number = frame->numbers.number<double>();
    if (frame->swap) number = swapped(number);
  }
  if (!frame->numbers.ok()) return std::nullopt;
  // orientation 4, covariance 9, rates 3, covariance 9, acceleration 3, covariance 9
  ImuMessage out;
  out.stamp = frame->stamp;
  std::copy_n(numbers.begin() + 13, 3, out.values.begin());
  std::copy_n(numbers.begin() + 25, 3, out.values.begin() + 3);
  out.has_gyro = numbers[16] != -1.0;
  out.has_acc = numbers[28] != -1.0;
  return out;
}

ImuCollector::ImuCollector(std::string file, const ImportOptions& options)
    : file_(std::move(file)), options_(options) {
  const auto wanted = [&](std::string_view name) {
    return std::any_of(options.channels.begin(), options.channels.end(),
                       [&](const std::string& pattern) { return matches(pattern, name); });
  };
  const bool all =
      options.beside || options.axes_to_judge || std::none_of(kNames.begin(), kNames.end(), wanted);
  for (std::size_t c = 0; c < kNames.size(); ++c) kept_[c] = all || wanted(kNames[c]);
}

void ImuCollector::topic(std::uint64_t number, std::string_view name, std::string_view type) {
  if (topics_.size() >= kMostTopics) return;
  topics_.try_emplace(number, Topic{std::string(name), std::string(type)});
}

bool ImuCollector::wants(std::uint64_t number) const {
  const auto found = topics_.find(number);
  if (found == topics_.end() || !is_imu_type(found->second.type)) return false;
  return options_.topic.empty() || found->second.name == options_.topic;
}

void ImuCollector::add(std::uint64_t number, Encoding encoding, std::string_view bytes,
                       std::int64_t received) {
  const Topic& topic = topics_.at(number);
  if (ambiguous_) return;
  Source& source = sources_[topic.name];
  const std::size_t index = source.messages++;
  const std::optional<ImuMessage> message = decode_imu(encoding, bytes);
  if (!message) {
    if (unreadable_++ == 0) {
      first_unreadable_ =
          fmt::format("topic {}: message {} is not a whole sensor_msgs/Imu", topic.name, index);
    }
    return;
  }
  if (source.times.size() == 0) {
    source.first = *message;
    source.header_time = message->stamp != 0;
  }
  const auto& values = message->values;
  const auto moves = [](double value) { return value != 0.0; };
  source.has_gyro = source.has_gyro || std::any_of(values.begin(), values.begin() + 3, moves);
  source.has_acc = source.has_acc || std::any_of(values.begin() + 3, values.end(), moves);
  source.times.push(source.header_time ? message->stamp : received);
  for (std::size_t c = 0; c < kNames.size(); ++c) {
    // A sensor that a topic lacks takes no memory.
    if (!kept_[c] || (values[c] == 0.0 && source.values[c].size() == 0)) continue;
    fill(source.times.size() - 1, source.values[c]);
    source.values[c].push(std::isfinite(values[c]) ? values[c]
                                                   : std::numeric_limits<double>::quiet_NaN());
  }
  if (index == 0 && sources_.size() > 1) return;  // what it holds shows later
  if (sources_.size() > 1 && !is_one_imu()) {
    ambiguous_ = true;
    for (auto& [name, one] : sources_) one = Source{};
  }
}

// Every kind of sensor in one topic only.
bool ImuCollector::is_one_imu() const {
  std::size_t gyros = 0;
  std::size_t accelerometers = 0;
  std::size_t silent = 0;
  for (const auto& [name, source] : sources_) {
    gyros += source.has_gyro ? 1U : 0U;
    accelerometers += source.has_acc ? 1U : 0U;
    silent += !source.has_gyro && !source.has_acc && source.times.size() > 0 ? 1U : 0U;
  }
  return gyros <= 1 && accelerometers <= 1 && silent == 0;
}

Result<void> ImuCollector::check_topics() const {
  constexpr std::size_t shown = 40;
  std::string all;
  std::string of_imu;
  std::size_t listed = 0;
  for (const auto& [number, topic] : topics_) {
    if (++listed > shown) break;
    all += fmt::format("{}{} ({})", all.empty() ? "" : ", ", topic.name, topic.type);
    if (!is_imu_type(topic.type)) continue;
    of_imu += fmt::format("{}{}", of_imu.empty() ? "" : ", ", topic.name);
  }
  if (ambiguous_) {
    return fail(
        fmt::format("{}: several topics of an IMU: {}; choose one with --topic", file_, of_imu));
  }
  if (!sources_.empty()) return {};
  if (!options_.topic.empty()) {
    return fail(
        fmt::format("{}: no message of type sensor_msgs/Imu in topic '{}' (it has: {}); "
                    "choose with --topic",
                    file_, options_.topic, all.empty() ? "none" : all));
  }
  return fail(
      fmt::format("{}: no message of type sensor_msgs/Imu (topics: {}); record the topic "
                  "of the IMU",
                  file_, all.empty() ? "none" : all));
}

// The sensors that it holds; all, where none was ever seen to move.
TimedStream ImuCollector::stream_of(const std::string& name, Source& source) const {
  TimedStream out{name, {}, {}};
  const bool none = !source.has_gyro && !source.has_acc;
  for (std::size_t c = 0; c < kNames.size(); ++c) {
    const bool gyro = c < 3;
    // Of several topics, the one that holds the sensor is meant.
    const bool named = sources_.size() == 1 &&
                       std::any_of(options_.channels.begin(), options_.channels.end(),
                                   [&](const std::string& one) { return one == kNames[c]; });
    const bool there = gyro ? source.first.has_gyro && (none || source.has_gyro)
                            : source.first.has_acc && (none || source.has_acc);
    if (!kept_[c] || (!there && !named)) continue;
    fill(source.times.size(), source.values[c]);
    out.columns.push_back(
        {std::string(kNames[c]), source.values[c].take(), 1.0, 0.0, gyro ? "rad/s" : "m/s^2"});
  }
  out.times = std::exchange(source.times, {});
  return out;
}

Result<Table> ImuCollector::finish(bool truncated) {
  std::erase_if(sources_, [](const auto& one) { return one.second.times.size() == 0; });
  if (sources_.size() > 1 && !is_one_imu()) ambiguous_ = true;
  if (const Result<void> sound = check_topics(); !sound) return tl::make_unexpected(sound.error());
  const bool header_time = sources_.begin()->second.header_time;
  std::vector<TimedStream> streams;
  for (auto& [name, source] : sources_) streams.push_back(stream_of(name, source));
  auto table = join_streams(file_, std::move(streams),
                            header_time ? "header.stamp" : "time of recording", options_);
  if (!table) return table;
  table->row = [](std::size_t i) { return fmt::format("message {}", i); };
  table->truncated = truncated;
  table->unreadable = unreadable_;
  table->first_unreadable = first_unreadable_;
  return table;
}

}  // namespace imunoise::recording
