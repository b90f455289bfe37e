#pragma once

// What drivers, devices, streams and options are, in C++: the words that host and plugins share.
// Header only and free of everything but the standard library, for it is installed.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "drivers/driver.h"

namespace imunoise::drivers {

/// How a device stores its numbers.
enum class NumberType : std::uint32_t {
  kInt16 = IMUNOISE_INT16,
  kInt32 = IMUNOISE_INT32,
  kInt64 = IMUNOISE_INT64,
  kFloat32 = IMUNOISE_FLOAT32,
  kFloat64 = IMUNOISE_FLOAT64,
};

/// Bytes of one number.
constexpr std::size_t width(NumberType type) {
  switch (type) {
    case NumberType::kInt16:
      return 2;
    case NumberType::kInt32:
    case NumberType::kFloat32:
      return 4;
    case NumberType::kInt64:
    case NumberType::kFloat64:
      break;
  }
  return 8;
}

/// The NumberType of a C++ type.
template <class Number>
constexpr NumberType number_type() = delete;
template <>
constexpr NumberType number_type<std::int16_t>() {
  return NumberType::kInt16;
}
template <>
constexpr NumberType number_type<std::int32_t>() {
  return NumberType::kInt32;
}
template <>
constexpr NumberType number_type<std::int64_t>() {
  return NumberType::kInt64;
}
template <>
constexpr NumberType number_type<float>() {
  return NumberType::kFloat32;
}
template <>
constexpr NumberType number_type<double>() {
  return NumberType::kFloat64;
}

/// Calls `visitor` with a number of the C++ type (its value means nothing) that `type` names.
template <class Visitor>
constexpr decltype(auto) with_number_type(NumberType type, Visitor&& visitor) {
  switch (type) {
    case NumberType::kInt16:
      return visitor(std::int16_t{});
    case NumberType::kInt32:
      return visitor(std::int32_t{});
    case NumberType::kInt64:
      return visitor(std::int64_t{});
    case NumberType::kFloat32:
      return visitor(float{});
    case NumberType::kFloat64:
      break;
  }
  return visitor(double{});
}

/// One column of samples. Value in units = add_offset + scale_factor · number.
struct Channel {
  std::string name;         ///< Unique in its stream, without '/': "gyro_x".
  std::string units = "1";  ///< "rad/s", "deg/s", "K", ...; "1" where none is known.
  NumberType type = NumberType::kFloat64;
  double scale_factor = 1.0;   ///< Units per number; not 0.
  double add_offset = 0.0;     ///< Units.
  std::string long_name = {};  ///< "angular rate about x"; may be empty.

  bool operator==(const Channel&) const = default;
};

/// Channels that share one clock, one counter, one time column.
struct Stream {
  std::string name;  ///< Unique in its device, without '/': "imu".
  std::vector<Channel> channels;
  double nominal_rate_hz = 0.0;       ///< Hz; 0: not evenly sampled.
  std::uint64_t counter_maximum = 0;  ///< After it the sample counter is 0 again; 0: no counter.
  double device_time_tick_s = 0.0;    ///< Resolution of the device's clock, s; 0: it has none.
};

/// Types of options. A flag is "true" or "false".
enum class OptionType : std::uint32_t {
  kFlag = IMUNOISE_OPTION_FLAG,
  kInteger = IMUNOISE_OPTION_INTEGER,
  kNumber = IMUNOISE_OPTION_NUMBER,
  kText = IMUNOISE_OPTION_TEXT,
};

/// What the user of a driver may choose.
struct Option {
  std::string name;  ///< Lower case letters, digits, '_'.
  OptionType type = OptionType::kText;
  std::string description;                     ///< One sentence.
  std::string unit = {};                       ///< "Hz", "s", ...; empty: none.
  std::optional<std::string> by_default = {};  ///< As a user writes it; unset: absent unless given.
  bool required = false;                       ///< Must be given; has no default.
  bool repeated = false;                       ///< May be given several times.
  double minimum = -std::numeric_limits<double>::infinity();  ///< Of numbers; included.
  double maximum = std::numeric_limits<double>::infinity();   ///< Of numbers; included.
  std::vector<std::string> choices = {};  ///< The texts that are allowed; empty: any.
};

/// What a driver says of itself.
struct DriverInfo {
  std::string name;  ///< Lower case letters, digits, '-', '_'.
  std::string description;
  std::string version;
  std::vector<Option> options;
  std::vector<Stream> streams = {};  ///< What its devices usually deliver; empty: known once open.
};

/// What an open device is.
struct DeviceInfo {
  std::vector<Stream> streams;
  std::string product = {};   ///< As the device names itself.
  std::string serial = {};    ///< Tells it from its like.
  std::string firmware = {};  ///< Version.
};

}  // namespace imunoise::drivers
