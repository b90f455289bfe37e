#include "recording/import/ulog/ulog_topics.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace imunoise::recording {
namespace {

const std::vector<UlogTopic>& known_topics() {
  using Kind = UlogTopic::Kind;
  static const std::vector<UlogTopic> kTopics = {
      {"sensor_gyro_fifo", 0, Kind::kFifo, {{"gyro", "rad/s", {"x", "y", "z"}}}},
      {"sensor_accel_fifo", 0, Kind::kFifo, {{"acc", "m/s^2", {"x", "y", "z"}}}},
      {"sensor_gyro", 1, Kind::kValues, {{"gyro", "rad/s", {"x", "y", "z"}}}},
      {"sensor_accel", 1, Kind::kValues, {{"acc", "m/s^2", {"x", "y", "z"}}}},
      {"sensor_combined",
       2,
       Kind::kValues,
       {{"gyro", "rad/s", {"gyro_rad"}}, {"acc", "m/s^2", {"accelerometer_m_s2"}}}},
      {"vehicle_imu",
       3,
       Kind::kIncrement,
       {{"gyro", "rad/s", {"delta_angle"}, "delta_angle_dt"},
        {"acc", "m/s^2", {"delta_velocity"}, "delta_velocity_dt"}}}};
  return kTopics;
}

double number_in(std::string_view message, const UlogField& field, std::size_t index = 0) {
  return ulog_number(field.type, message.data() + field.offset + index * ulog_width(field.type));
}

// ns; a damaged stamp may be anything.
std::int64_t stamp_in(std::string_view message, const UlogField& field) {
  const double us = number_in(message, field);
  return us >= 0.0 && us < 9e15 ? static_cast<std::int64_t>(us) * 1000 : -1;
}

double finite_or_missing(double value) {
  return std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

const UlogTopic* find_ulog_topic(std::string_view name) {
  const auto& all = known_topics();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const UlogTopic& one) { return one.name == name; });
  return found == all.end() ? nullptr : &*found;
}

std::optional<UlogSamples> UlogSamples::make(const UlogTopic& topic, std::string name,
                                             const UlogFormats& formats) {
  UlogSamples out;
  out.topic_ = &topic;
  out.name_ = std::move(name);
  const std::string format(topic.name);
  const auto need = [&](std::string_view field) {
    const auto found = formats.find(format, field);
    if (found) {
      out.least_ = std::max(out.least_, found->offset + found->count * ulog_width(found->type));
    }
    return found;
  };
  auto time = need("timestamp_sample");
  if (!time) time = need("timestamp");
  if (!time) return std::nullopt;
  out.time_ = *time;
  if (topic.kind == UlogTopic::Kind::kFifo) {
    out.step_ = need("dt");
    out.scale_ = need("scale");
    out.count_ = need("samples");
    if (!out.step_ || !out.scale_ || !out.count_) return std::nullopt;
  }
  for (const UlogTopic::Part& about : topic.parts) {
    Part& part = out.parts_.emplace_back();
    part.about = &about;
    if (!about.step.empty() && !(part.step = need(about.step))) return std::nullopt;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool in_array = about.fields[1].empty();
      const auto field = need(about.fields[in_array ? 0 : axis]);
      if (!field || (in_array && field->count < 3)) return std::nullopt;
      part.axes[axis].field = *field;
      part.axes[axis].shift = in_array ? axis : 0;
    }
  }
  return out;
}

bool UlogSamples::add(std::string_view message) {
  if (message.size() < least_) return false;
  const std::int64_t time = stamp_in(message, time_);
  if (time < 0) return false;
  return topic_->kind == UlogTopic::Kind::kFifo ? add_fifo(message, time) : add_one(message, time);
}

// The stamp is that of the last sample.
bool UlogSamples::add_fifo(std::string_view message, std::int64_t last) {
  const double count = number_in(message, *count_);
  const double step = number_in(message, *step_) * 1e3;  // ns
  const double scale = number_in(message, *scale_);
  const auto room = static_cast<double>(parts_.front().axes[0].field.count);
  if (!(count >= 1.0) || count > room || !(step >= 0.0 && step < 1e10) || !std::isfinite(scale))
    return false;
  const auto samples = static_cast<std::size_t>(count);
  for (std::size_t i = 0; i < samples; ++i) {
    const double before = step * static_cast<double>(samples - 1 - i);
    times_.push(last - static_cast<std::int64_t>(std::llround(before)));
    for (Axis& axis : parts_.front().axes)
      axis.values.push(finite_or_missing(scale * number_in(message, axis.field, i)));
  }
  return true;
}

bool UlogSamples::add_one(std::string_view message, std::int64_t time) {
  times_.push(time);
  for (Part& part : parts_) {
    const double over = part.step ? 1e-6 * number_in(message, *part.step) : 1.0;  // s
    for (Axis& axis : part.axes)
      axis.values.push(finite_or_missing(number_in(message, axis.field, axis.shift) / over));
  }
  return true;
}

TimedStream UlogSamples::take() {
  TimedStream out{name_, std::exchange(times_, {}), {}};
  for (Part& part : parts_) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      out.columns.push_back({fmt::format("{}_{}", part.about->channel, "xyz"[axis]),
                             part.axes[axis].values.take(), 1.0, 0.0,
                             std::string(part.about->unit)});
    }
  }
  return out;
}

}  // namespace imunoise::recording
