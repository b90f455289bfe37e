#pragma once

// The messages that configure an Xsens device, and its answers. Source: Xsens MT0101P 2020.A and
// ethzasl_xsens_driver, which agree.

#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/support/result.h"
#include "drivers/codec/bytes.h"

namespace imunoise::drivers {

/// What a message is for. The answer to a request has the next higher number: acknowledged_by().
enum class XsensMessage : std::uint8_t {
  kRequestDeviceId = 0x00,
  kDeviceId = 0x01,
  kSetPeriod = 0x04,  ///< Legacy; ticks of 1/115200 s.
  kRequestConfiguration = 0x0c,
  kConfiguration = 0x0d,
  kRestoreFactoryDefaults = 0x0e,
  kGoToMeasurement = 0x10,
  kRequestFirmwareRevision = 0x12,
  kFirmwareRevision = 0x13,
  kSetBaudRate = 0x18,
  kRequestProductCode = 0x1c,
  kProductCode = 0x1d,
  kRunSelfTest = 0x24,
  kGoToConfig = 0x30,
  kMtData = 0x32,
  kRequestData = 0x34,
  kMtData2 = 0x36,
  kWakeUp = 0x3e,
  kWakeUpAcknowledge = 0x3f,
  kReset = 0x40,
  kError = 0x42,
  kSetOutputConfiguration = 0xc0,
  kOutputConfiguration = 0xc1,
  kSetOutputMode = 0xd0,        ///< Legacy.
  kSetOutputSettings = 0xd2,    ///< Legacy.
  kSetOutputSkipFactor = 0xd4,  ///< Legacy.
};

/// Message identifier of the answer to `request`.
constexpr std::uint8_t acknowledged_by(XsensMessage request) {
  return static_cast<std::uint8_t>(static_cast<std::uint8_t>(request) + 1U);
}

/// A frame without payload: GoToConfig, GoToMeasurement, Reset, every request.
std::vector<std::uint8_t> encode_message(XsensMessage message, Bytes payload = {});

/// The payload of a message that carries one number.
template <std::integral T>
std::vector<std::uint8_t> payload_of(T number) {
  std::vector<std::uint8_t> out;
  append_big_endian(out, number);
  return out;
}

/// One output of an MTData2 device.
struct XsensOutput {
  std::uint16_t data_id = 0;  ///< With its format and frame in the low nibble, e.g. 0x4020.
  std::uint16_t rate_hz = 0;  ///< 0xffff: as fast as it comes.
  friend bool operator==(const XsensOutput&, const XsensOutput&) = default;
};

inline constexpr std::size_t kXsensMaximumOutputs = 32;

/// The payload of SetOutputConfiguration and of its answer. Without payload the message asks for
/// the present outputs. Precondition: at most 32. {0, 0} as the only one returns a device of the
/// fourth generation to legacy MTData.
std::vector<std::uint8_t> payload_of(std::span<const XsensOutput> outputs);
/// Payload of (Set)OutputConfiguration. Error: its length.
Result<std::vector<XsensOutput>> decode_output_configuration(Bytes payload);

/// The payload of SetBaudRate, in force after the next reset. Nothing if the device has no such
/// rate.
std::optional<std::uint8_t> baud_code_of(std::uint32_t baud);
/// Baud rates in the order in which a device of unknown setting is best searched: the factory's
/// first, then the common ones.
std::span<const std::uint32_t> baud_rates();
/// The rate that `code` stands for in a device's answer.
std::optional<std::uint32_t> baud_rate_of(std::uint8_t code);

/// What an Error message says, e.g. "invalid message".
std::string_view error_text(std::uint8_t code);

}  // namespace imunoise::drivers
