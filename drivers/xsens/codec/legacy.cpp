#include "drivers/xsens/codec/legacy.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <initializer_list>

#include "drivers/codec/si_unit.h"
#include "drivers/xsens/codec/field.h"

namespace imunoise::drivers {
namespace {

using Kind = XsensField::Kind;

// A unit as the device states it, and in SI.
struct FieldUnit {
  explicit FieldUnit(std::string_view text) : name(text), si(si_unit(text)) {}
  std::string_view name;
  SiUnit si;
};

struct LegacyField {
  Kind kind;
  std::string_view channel;
  const FieldUnit* unit;
  double scale;
};

struct Units {
  FieldUnit none{"1"};
  FieldUnit counts{"counts"};
  FieldUnit second{"s"};
  FieldUnit metre{"m"};
  FieldUnit degree{"deg"};
  FieldUnit celsius{"degC"};
  FieldUnit field{"a.u."};
  FieldUnit rate{"rad/s"};
  FieldUnit velocity{"m/s"};
  FieldUnit acceleration{"m/s^2"};
};

constexpr std::size_t kConfigurationBytes = 118;
constexpr double kPeriodTicksPerSecond = 115200.0;

enum Mode : std::uint32_t {
  kTemperature = 0x0001,
  kCalibrated = 0x0002,
  kOrientation = 0x0004,
  kAuxiliary = 0x0008,
  kPosition = 0x0010,
  kVelocity = 0x0020,
  kStatus = 0x0800,
  kRawGps = 0x1000,
  kRaw = 0x4000,
};

enum Setting : std::uint32_t {
  kCounter = 0x0001,
  kUtc = 0x0002,
  kEuler = 0x0004,
  kMatrix = 0x0008,
  kNoAcceleration = 0x0010,
  kNoRate = 0x0020,
  kNoField = 0x0040,
  kNoAnalog1 = 0x0400,
  kNoAnalog2 = 0x0800,
  kNed = 0x8000'0000,
};

// The groups that come before the status byte, in the order of the wire.
std::vector<LegacyField> fields_of(LegacyLayout layout) {
  static const Units kUnits;
  std::vector<LegacyField> out;
  const auto add = [&](Kind kind, const FieldUnit& unit,
                       std::initializer_list<std::string_view> channels, double scale = 1.0) {
    for (const std::string_view channel : channels) out.push_back({kind, channel, &unit, scale});
  };
  const auto has = [&](Mode group) { return (layout.mode & group) != 0; };
  const auto set = [&](Setting bit) { return (layout.settings & bit) != 0; };
  if (has(kRaw)) {
    add(Kind::kU16, kUnits.counts,
        {"raw_acc_x", "raw_acc_y", "raw_acc_z", "raw_gyro_x", "raw_gyro_y", "raw_gyro_z",
         "raw_mag_x", "raw_mag_y", "raw_mag_z", "raw_temperature"});
  }
  if (has(kRawGps)) {  // scales are those of the u-blox receiver inside
    add(Kind::kU16, kUnits.counts, {"gps_pressure"});
    add(Kind::kU8, kUnits.none, {"gps_pressure_age"});
    add(Kind::kU32, kUnits.second, {"gps_time_of_week"}, 1e-3);
    add(Kind::kI32, kUnits.degree, {"gps_latitude", "gps_longitude"}, 1e-7);
    add(Kind::kI32, kUnits.metre, {"gps_height"}, 1e-3);
    add(Kind::kI32, kUnits.velocity,
        {"gps_velocity_north", "gps_velocity_east", "gps_velocity_down"}, 0.01);
    add(Kind::kU32, kUnits.metre, {"gps_horizontal_accuracy", "gps_vertical_accuracy"}, 1e-3);
    add(Kind::kU32, kUnits.velocity, {"gps_speed_accuracy"}, 0.01);
    add(Kind::kU8, kUnits.none, {"gps_age"});
  }
  if (has(kTemperature)) add(Kind::kNumber, kUnits.celsius, {"temperature"});
  if (has(kCalibrated)) {
    if (!set(kNoAcceleration)) add(Kind::kNumber, kUnits.acceleration, {"acc_x", "acc_y", "acc_z"});
    if (!set(kNoRate)) add(Kind::kNumber, kUnits.rate, {"gyro_x", "gyro_y", "gyro_z"});
    if (!set(kNoField)) add(Kind::kNumber, kUnits.field, {"mag_x", "mag_y", "mag_z"});
  }
  if (has(kOrientation)) {
    if (set(kEuler)) {
      add(Kind::kNumber, kUnits.degree, {"roll", "pitch", "yaw"});
    } else if (set(kMatrix)) {
      add(Kind::kNumber, kUnits.none,
          {"r11", "r21", "r31", "r12", "r22", "r32", "r13", "r23", "r33"});
    } else {
      add(Kind::kNumber, kUnits.none, {"q0", "q1", "q2", "q3"});
    }
  }
  if (has(kAuxiliary)) {
    if (!set(kNoAnalog1)) add(Kind::kU16, kUnits.counts, {"analog_1"});
    if (!set(kNoAnalog2)) add(Kind::kU16, kUnits.counts, {"analog_2"});
  }
  if (has(kPosition)) {
    add(Kind::kNumber, kUnits.degree, {"latitude", "longitude"});
    add(Kind::kNumber, kUnits.metre, {"altitude"});
  }
  if (has(kVelocity))
    add(Kind::kNumber, kUnits.velocity, {"velocity_x", "velocity_y", "velocity_z"});
  return out;
}

void append_whole(std::vector<std::uint8_t>& out, Kind kind, double number) {
  switch (kind) {
    case Kind::kU8:
      return out.push_back(static_cast<std::uint8_t>(std::llround(number)));
    case Kind::kU16:
      return append_big_endian(out, static_cast<std::uint16_t>(std::llround(number)));
    case Kind::kU32:
      return append_big_endian(out, static_cast<std::uint32_t>(std::llround(number)));
    default:
      return append_big_endian(out, static_cast<std::int32_t>(std::llround(number)));
  }
}

}  // namespace

LegacyLayout calibrated_layout(LegacyCalibrated wanted, XsensFormat format) {
  const auto mode = kCalibrated | kStatus | (wanted.temperature ? kTemperature : 0U);
  const auto settings = kCounter | static_cast<std::uint32_t>(format) << 8U |
                        (wanted.acceleration ? 0U : kNoAcceleration) |
                        (wanted.rate ? 0U : kNoRate) | (wanted.field ? 0U : kNoField);
  return {static_cast<std::uint16_t>(mode), settings};
}

double rate_of(const XsensConfiguration& configuration) {
  return kPeriodTicksPerSecond / configuration.period / (configuration.skip_factor + 1);
}

std::uint16_t legacy_period(double rate_hz) {
  return static_cast<std::uint16_t>(std::lround(kPeriodTicksPerSecond / rate_hz));
}

Result<XsensConfiguration> decode_configuration(Bytes payload) {
  if (payload.size() != kConfigurationBytes) {
    return fail(
        fmt::format("Configuration: {} bytes of payload instead of {}; ask the device again",
                    payload.size(), kConfigurationBytes));
  }
  BigEndianReader in(payload);
  XsensConfiguration out;
  out.device_id = in.take<std::uint32_t>();
  out.period = in.take<std::uint16_t>();
  out.skip_factor = in.take<std::uint16_t>();
  // SyncIn mode, skip and offset; date and time of calibration; reserved; number of devices; the
  // first device's identifier and data length
  in.take_bytes(2 + 2 + 4 + 8 + 8 + 32 + 32 + 2 + 4 + 2);
  out.layout.mode = in.take<std::uint16_t>();
  out.layout.settings = in.take<std::uint32_t>();
  return out;
}

std::vector<std::uint8_t> encode_configuration(const XsensConfiguration& configuration) {
  std::vector<std::uint8_t> out;
  append_big_endian(out, configuration.device_id);
  append_big_endian(out, configuration.period);
  append_big_endian(out, configuration.skip_factor);
  out.resize(out.size() + 2 + 2 + 4 + 8 + 8 + 32 + 32);
  append_big_endian(out, std::uint16_t{1});
  append_big_endian(out, configuration.device_id);
  append_big_endian(out, std::uint16_t{0});
  append_big_endian(out, configuration.layout.mode);
  append_big_endian(out, configuration.layout.settings);
  out.resize(kConfigurationBytes);
  return out;
}

std::vector<LegacyChannel> channels_of(LegacyLayout layout) {
  std::vector<LegacyChannel> out;
  for (const LegacyField& field : fields_of(layout))
    out.push_back({field.channel, field.unit->name});
  return out;
}

XsensFormat format_of(LegacyLayout layout) {
  return static_cast<XsensFormat>(layout.settings >> 8U & 3U);
}

bool decode_legacy(Bytes payload, LegacyLayout layout, LegacyData& out, Refusals& refused) {
  out.counter.reset();
  out.status.reset();
  out.numbers.clear();
  out.sample.clear();
  out.sample.stream = "imu";
  Refusals within;
  BigEndianReader in(payload);
  for (const LegacyField& field : fields_of(layout)) {
    const double number = field.kind == Kind::kNumber ? take_number(in, format_of(layout))
                                                      : take_whole(in, field.kind) * field.scale;
    out.numbers.push_back(number);
    append_value(out.sample, field.channel, field.unit->si, number, within);
  }
  if ((layout.mode & kStatus) != 0) {
    out.status = in.take<std::uint8_t>();
    append_status_flags(*out.status, out.sample.flags);
  }
  if ((layout.settings & kCounter) != 0) out.counter = in.take<std::uint16_t>();
  if ((layout.settings & kUtc) != 0) append_utc_value(out.sample, take_utc(in), within);
  if ((layout.settings & kNed) != 0) out.sample.flags.push_back("ned");
  if (!in.ok() || in.left() > 0) {
    refused.add(Refusal::kLength);
    return false;
  }
  refused += within;
  return true;
}

std::vector<std::uint8_t> encode_legacy(LegacyLayout layout, std::span<const double> numbers,
                                        std::uint8_t status, std::uint16_t counter,
                                        const XsensUtc& utc) {
  const std::vector<LegacyField> fields = fields_of(layout);
  assert(numbers.size() == fields.size());
  std::vector<std::uint8_t> out;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i].kind == Kind::kNumber) {
      append_number(out, format_of(layout), numbers[i]);
    } else {
      append_whole(out, fields[i].kind, numbers[i] / fields[i].scale);
    }
  }
  if ((layout.mode & kStatus) != 0) out.push_back(status);
  if ((layout.settings & kCounter) != 0) append_big_endian(out, counter);
  if ((layout.settings & kUtc) != 0) append_utc(out, utc);
  return out;
}

}  // namespace imunoise::drivers
