#include "drivers/xsens/codec/messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>

#include "drivers/xsens/codec/frame.h"

namespace imunoise::drivers {
namespace {

struct BaudCode {
  std::uint32_t baud;
  std::uint8_t code;
};

// In the order of a search; 921600 has two codes, of which devices understand the first.
constexpr std::array kBaudCodes = {
    BaudCode{115200, 0x02},  BaudCode{921600, 0x80},  BaudCode{460800, 0x00},
    BaudCode{230400, 0x01},  BaudCode{2000000, 0x0c}, BaudCode{57600, 0x04},
    BaudCode{38400, 0x05},   BaudCode{19200, 0x07},   BaudCode{9600, 0x09},
    BaudCode{4000000, 0x0d}, BaudCode{3686400, 0x0e}, BaudCode{76800, 0x03},
    BaudCode{28800, 0x06},   BaudCode{14400, 0x08},   BaudCode{4800, 0x0b},
};
constexpr std::uint8_t kOther921600 = 0x0a;

constexpr auto kBaudRates = [] {
  std::array<std::uint32_t, kBaudCodes.size()> out{};
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = kBaudCodes[i].baud;
  return out;
}();

}  // namespace

std::vector<std::uint8_t> encode_message(XsensMessage message, Bytes payload) {
  return encode_xbus_frame(static_cast<std::uint8_t>(message), payload);
}

std::vector<std::uint8_t> payload_of(std::span<const XsensOutput> outputs) {
  assert(outputs.size() <= kXsensMaximumOutputs);
  std::vector<std::uint8_t> payload;
  for (const XsensOutput& output : outputs) {
    append_big_endian(payload, output.data_id);
    append_big_endian(payload, output.rate_hz);
  }
  return payload;
}

Result<std::vector<XsensOutput>> decode_output_configuration(Bytes payload) {
  if (payload.size() % 4 != 0 || payload.size() > 4 * kXsensMaximumOutputs) {
    return fail(
        fmt::format("OutputConfiguration: {} bytes of payload; at most {} entries of 4 bytes "
                    "are possible; ask the device again",
                    payload.size(), kXsensMaximumOutputs));
  }
  std::vector<XsensOutput> out;
  for (BigEndianReader in(payload); in.left() > 0;) {
    const auto data_id = in.take<std::uint16_t>();
    out.push_back({data_id, in.take<std::uint16_t>()});
  }
  return out;
}

std::optional<std::uint8_t> baud_code_of(std::uint32_t baud) {
  const auto* const found = std::find_if(kBaudCodes.begin(), kBaudCodes.end(),
                                         [&](const BaudCode& code) { return code.baud == baud; });
  if (found == kBaudCodes.end()) return std::nullopt;
  return found->code;
}

std::span<const std::uint32_t> baud_rates() { return kBaudRates; }

std::optional<std::uint32_t> baud_rate_of(std::uint8_t code) {
  if (code == kOther921600) return 921600;
  const auto* const found = std::find_if(kBaudCodes.begin(), kBaudCodes.end(),
                                         [&](const BaudCode& known) { return known.code == code; });
  if (found == kBaudCodes.end()) return std::nullopt;
  return found->baud;
}

std::string_view error_text(std::uint8_t code) {
  switch (code) {
    case 0x03:
      return "the period is out of range";
    case 0x04:
      return "invalid message";
    case 0x1e:
      return "timer overflow: more output than the device or the line can carry";
    case 0x20:
      return "the baud rate is out of range";
    case 0x21:
      return "a parameter is out of range";
    case 0x28:
      return "the device has an error; try a reset";
    default:
      return "unknown error";
  }
}

}  // namespace imunoise::drivers
