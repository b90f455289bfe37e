#pragma once

// MTData2: a message of self-describing items {identifier, length, data}. Source: Xsens MT0101P
// 2020.A; numbers agree with captures of real devices in all four formats.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "drivers/codec/bytes.h"
#include "drivers/codec/refusal.h"
#include "drivers/codec/sample.h"
#include "drivers/xsens/codec/fields.h"
#include "drivers/xsens/codec/items.h"

namespace imunoise::drivers {

/// Identifier and data of one item; the data is borrowed.
struct XsensItemData {
  std::uint16_t id = 0;  ///< With format and frame.
  Bytes data;
};

/// Takes the next item off the front of `payload`; nothing at the end, or (then `payload` is not
/// empty) where an item is longer than what is left.
std::optional<XsensItemData> take_item(Bytes& payload);

/// The numbers of one item, as a range of MtData2::numbers; none where its length is wrong.
struct XsensItemNumbers {
  std::uint16_t id = 0;  ///< With format and frame.
  std::size_t first = 0;
  std::size_t count = 0;
};

/// What one MTData2 message says.
struct MtData2 {
  std::optional<std::uint16_t> packet_counter;
  std::optional<std::uint32_t> sample_time_fine;  ///< Ticks of 100 µs.
  std::optional<std::uint32_t> status;            ///< Word, or byte.
  /// stream ("gnss" where the receiver speaks, else "imu"), values and flags; no time, no counter.
  DecodedSample sample;
  /// Its items of numbers, in their order, and these numbers as the device sent them.
  std::vector<XsensItemNumbers> items;
  std::vector<double> numbers;
};

/// Reads every item of `payload`; unknown items are skipped, those of a wrong length refused.
/// `out` is overwritten.
void decode_mtdata2(Bytes payload, MtData2& out, Refusals& refused);

/// Composes the payload of an MTData2 message.
class MtData2Writer {
 public:
  void packet_counter(std::uint16_t count);
  void sample_time_fine(std::uint32_t ticks);
  void utc(const XsensUtc& utc);
  void status_word(std::uint32_t status);
  void pressure(std::uint32_t pascal);
  /// Any item of numbers: in the units of the device (rad/s, m/s², °C, °).
  void numbers(XsensItem item, XsensFormat format, std::span<const double> values);
  /// Anything else. Precondition: at most 255 bytes.
  void raw(std::uint16_t id, Bytes data);

  Bytes payload() const { return payload_; }

 private:
  void header(std::uint16_t id, std::size_t bytes);

  std::vector<std::uint8_t> payload_;
};

}  // namespace imunoise::drivers
