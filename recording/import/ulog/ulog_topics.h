#pragma once

// The topics of PX4 that hold an IMU's samples. Source: PX4's messages (msg/SensorGyroFifo.msg,
// SensorAccelFifo, SensorGyro, SensorAccel, SensorCombined, VehicleImu).

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recording/import/table/blocks.h"
#include "recording/import/table/streams.h"
#include "recording/import/table/times.h"
#include "recording/import/ulog/ulog_layout.h"

namespace imunoise::recording {

/// How samples lie in a topic's messages.
struct UlogTopic {
  enum class Kind {
    kFifo,       ///< raw numbers of many samples, with one scale and one step
    kValues,     ///< one sample
    kIncrement,  ///< one sample that was integrated over a stated time
  };
  struct Part {
    std::string_view channel;                ///< "gyro": gyro_x, gyro_y, gyro_z
    std::string_view unit;                   ///< of a rate
    std::array<std::string_view, 3> fields;  ///< of the axes; one array where the others are empty
    std::string_view step = {};              ///< field of its time (µs)
  };
  std::string_view name;
  int rank;  ///< the lower, the nearer to the sensor
  Kind kind;
  std::vector<Part> parts;
};

/// Nothing: the topic holds no samples of an IMU.
const UlogTopic* find_ulog_topic(std::string_view name);

/// Samples of one topic, decoded message by message.
class UlogSamples {
 public:
  /// Nothing where the log's format lacks a field that is needed.
  static std::optional<UlogSamples> make(const UlogTopic& topic, std::string name,
                                         const UlogFormats& formats);

  int rank() const { return topic_->rank; }
  /// One message. False: it is too short, or says what cannot be.
  bool add(std::string_view message);
  TimedStream take();

 private:
  struct Axis {
    UlogField field;
    std::size_t shift = 0;  // bytes from the field's begin
    Blocks<double> values;
  };
  struct Part {
    const UlogTopic::Part* about = nullptr;
    std::array<Axis, 3> axes;
    std::optional<UlogField> step;
  };

  bool add_fifo(std::string_view message, std::int64_t last);
  bool add_one(std::string_view message, std::int64_t time);

  const UlogTopic* topic_ = nullptr;
  std::string name_;
  UlogField time_;
  std::optional<UlogField> step_;   // of a FIFO (µs)
  std::optional<UlogField> scale_;  // of a FIFO
  std::optional<UlogField> count_;  // of a FIFO
  std::vector<Part> parts_;
  std::size_t least_ = 0;  // bytes that a message needs
  Times times_;
};

}  // namespace imunoise::recording
