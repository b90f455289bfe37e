#include "drivers/can/codec/presets.h"

#include <fmt/format.h>

#include <array>

#include "drivers/can/codec/dbc.h"
#include "drivers/can/codec/identifier.h"

namespace imunoise::drivers {
namespace {

constexpr std::string_view kMti600 = R"dbc(
BO_ 5 SampleTime: 4 IMU
 SG_ Time : 7|32@0+ (1,0) [0|0] "ticks" HOST
BO_ 6 Counter: 2 IMU
 SG_ Count : 7|16@0+ (1,0) [0|0] "1" HOST
BO_ 33 Quaternion: 8 IMU
 SG_ Q0 : 7|16@0- (3.0518509475997192e-05,0) [0|0] "1" HOST
 SG_ Q1 : 23|16@0- (3.0518509475997192e-05,0) [0|0] "1" HOST
 SG_ Q2 : 39|16@0- (3.0518509475997192e-05,0) [0|0] "1" HOST
 SG_ Q3 : 55|16@0- (3.0518509475997192e-05,0) [0|0] "1" HOST
BO_ 34 Euler: 6 IMU
 SG_ Roll : 7|16@0- (0.0078125,0) [0|0] "deg" HOST
 SG_ Pitch : 23|16@0- (0.0078125,0) [0|0] "deg" HOST
 SG_ Yaw : 39|16@0- (0.0078125,0) [0|0] "deg" HOST
BO_ 50 RateOfTurn: 6 IMU
 SG_ X : 7|16@0- (0.001953125,0) [0|0] "rad/s" HOST
 SG_ Y : 23|16@0- (0.001953125,0) [0|0] "rad/s" HOST
 SG_ Z : 39|16@0- (0.001953125,0) [0|0] "rad/s" HOST
BO_ 52 Acceleration: 6 IMU
 SG_ X : 7|16@0- (0.00390625,0) [0|0] "m/s2" HOST
 SG_ Y : 23|16@0- (0.00390625,0) [0|0] "m/s2" HOST
 SG_ Z : 39|16@0- (0.00390625,0) [0|0] "m/s2" HOST
BO_ 53 FreeAcceleration: 6 IMU
 SG_ X : 7|16@0- (0.00390625,0) [0|0] "m/s2" HOST
 SG_ Y : 23|16@0- (0.00390625,0) [0|0] "m/s2" HOST
 SG_ Z : 39|16@0- (0.00390625,0) [0|0] "m/s2" HOST
BO_ 65 MagneticField: 6 IMU
 SG_ X : 7|16@0- (0.0009765625,0) [0|0] "a.u." HOST
 SG_ Y : 23|16@0- (0.0009765625,0) [0|0] "a.u." HOST
 SG_ Z : 39|16@0- (0.0009765625,0) [0|0] "a.u." HOST
BO_ 81 Temperature: 2 IMU
 SG_ T : 7|16@0- (0.00390625,0) [0|0] "degC" HOST
BO_ 118 Velocity: 6 IMU
 SG_ X : 7|16@0- (0.015625,0) [0|0] "m/s" HOST
 SG_ Y : 23|16@0- (0.015625,0) [0|0] "m/s" HOST
 SG_ Z : 39|16@0- (0.015625,0) [0|0] "m/s" HOST
)dbc";

// Identifiers are those of source address 0: {0} is slope, {1} rate, {2} acceleration.
constexpr const char* kAceinna = R"dbc(
BO_ {0} Slope: 8 IMU
 SG_ Pitch : 0|24@1+ (3.0517578125e-05,-250) [0|0] "deg" HOST
 SG_ Roll : 24|24@1+ (3.0517578125e-05,-250) [0|0] "deg" HOST
BO_ {1} Rate: 8 IMU
 SG_ X : 0|16@1+ (0.0078125,-250) [0|0] "deg/s" HOST
 SG_ Y : 16|16@1+ (0.0078125,-250) [0|0] "deg/s" HOST
 SG_ Z : 32|16@1+ (0.0078125,-250) [0|0] "deg/s" HOST
BO_ {2} Acceleration: 8 IMU
 SG_ X : 0|16@1+ (0.01,-320) [0|0] "m/s2" HOST
 SG_ Y : 16|16@1+ (0.01,-320) [0|0] "m/s2" HOST
 SG_ Z : 32|16@1+ (0.01,-320) [0|0] "m/s2" HOST
)dbc";

constexpr std::string_view kMm510 = R"dbc(
BO_ 372 YawY: 8 IMU
 SG_ Yaw : 0|16@1+ (0.005,-163.84) [0|0] "deg/s" HOST
 SG_ Y : 32|16@1+ (0.000127465,-4.1768) [0|0] "g" HOST
BO_ 376 RollX: 8 IMU
 SG_ Roll : 0|16@1+ (0.005,-163.84) [0|0] "deg/s" HOST
 SG_ X : 32|16@1+ (0.000127465,-4.1768) [0|0] "g" HOST
BO_ 380 Z: 8 IMU
 SG_ Z : 32|16@1+ (0.000127465,-4.1768) [0|0] "g" HOST
)dbc";

struct Named {
  std::string_view name;
  CanPreset (*make)(std::uint8_t source_address);
};

constexpr std::array kPresets = {
    Named{"mti600", [](std::uint8_t) { return mti600_preset(); }},
    Named{"aceinna", aceinna_preset},
    Named{"mm5.10", [](std::uint8_t) { return mm510_preset(); }},
};

}  // namespace

CanPreset mti600_preset() {
  CanPreset out{std::string(kMti600),
                {{"SampleTime", "Time", "sample_time", "", {}},
                 {"Counter", "Count", "counter", "", {}},
                 {"Quaternion", "Q0", "q0", "", {}},
                 {"Quaternion", "Q1", "q1", "", {}},
                 {"Quaternion", "Q2", "q2", "", {}},
                 {"Quaternion", "Q3", "q3", "", {}},
                 {"Euler", "Roll", "roll", "", {}},
                 {"Euler", "Pitch", "pitch", "", {}},
                 {"Euler", "Yaw", "yaw", "", {}},
                 {"Temperature", "T", "temperature", "", {}}}};
  const std::array<std::pair<std::string_view, std::string_view>, 5> vectors = {
      {{"RateOfTurn", "gyro"},
       {"Acceleration", "acc"},
       {"FreeAcceleration", "free_acc"},
       {"MagneticField", "mag"},
       {"Velocity", "velocity"}}};
  for (const auto& [message, channel] : vectors) {
    for (const auto& [axis, suffix] :
         {std::pair("X", "x"), std::pair("Y", "y"), std::pair("Z", "z")}) {
      out.mapping.push_back(
          {std::string(message), axis, fmt::format("{}_{}", channel, suffix), "", {}});
    }
  }
  return out;
}

CanPreset aceinna_preset(std::uint8_t source_address) {
  constexpr std::uint64_t kInvalid16 = 0xfb00;
  constexpr std::uint64_t kInvalid24 = 0xfb0000;
  const auto id = [&](std::uint32_t of_address_0) {
    return kDbcExtendedFlag | of_address_0 | source_address;
  };
  return {fmt::format(fmt::runtime(kAceinna), id(0x0cf02900), id(0x0cf02a00), id(0x08f02d00)),
          {{"Slope", "Pitch", "pitch", "", kInvalid24},
           {"Slope", "Roll", "roll", "", kInvalid24},
           {"Rate", "X", "gyro_x", "", kInvalid16},
           {"Rate", "Y", "gyro_y", "", kInvalid16},
           {"Rate", "Z", "gyro_z", "", kInvalid16},
           {"Acceleration", "X", "acc_x", "", kInvalid16},
           {"Acceleration", "Y", "acc_y", "", kInvalid16},
           {"Acceleration", "Z", "acc_z", "", kInvalid16}}};
}

CanPreset mm510_preset() {
  return {std::string(kMm510),
          {{"YawY", "Yaw", "gyro_z", "", {}},
           {"YawY", "Y", "acc_y", "", {}},
           {"RollX", "Roll", "gyro_x", "", {}},
           {"RollX", "X", "acc_x", "", {}},
           {"Z", "Z", "acc_z", "", {}}}};
}

std::vector<std::string_view> preset_names() {
  std::vector<std::string_view> out;
  for (const Named& preset : kPresets) out.push_back(preset.name);
  return out;
}

Result<CanChannels> make_preset(std::string_view name, std::uint8_t source_address) {
  for (const Named& known : kPresets) {
    if (known.name != name) continue;
    const CanPreset preset = known.make(source_address);
    Result<CanDatabase> database = parse_dbc(preset.dbc, name);
    if (!database) return tl::unexpected(database.error());
    return CanChannels::make(std::move(*database), preset.mapping);
  }
  return fail(fmt::format("no CAN preset '{}'; known: {}", name, fmt::join(preset_names(), ", ")));
}

}  // namespace imunoise::drivers
