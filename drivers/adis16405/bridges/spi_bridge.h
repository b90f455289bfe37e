#pragma once

// What tells one USB-SPI bridge from another.

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "core/support/units.h"
#include "drivers/codec/bytes.h"
#include "drivers/transport/usb.h"

namespace imunoise::drivers::adis16405 {

/// Bytes both ways under one fall and rise of chip select.
struct SpiFrame {
  std::vector<std::uint8_t> send;
  bool on_data_ready = false;          ///< Waits for the sensor's data-ready edge first.
  std::chrono::microseconds pause{0};  ///< Least time until the next frame begins.
};

/// A USB-SPI bridge in mode 3. One thread at a time. Throws plugin::DeviceError.
class SpiBridge {
 public:
  SpiBridge() = default;
  SpiBridge(const SpiBridge&) = delete;
  SpiBridge& operator=(const SpiBridge&) = delete;
  virtual ~SpiBridge() = default;

  /// For messages: "FT232H".
  virtual std::string_view name() const = 0;
  /// Whether frames can wait for data-ready. Where not, `on_data_ready` must not be set.
  virtual bool sees_data_ready() const = 0;
  /// From any state of the chip to idle: nothing queued in it, nothing unread, lines at rest, the
  /// SPI clock at most `clock`. Ends a wait for data-ready. Precondition: all that was sent by this
  /// `usb` is answered.
  virtual void start(usb::Handle& usb, Hertz clock) = 0;
  /// The OUT transfers that make the frames happen, in order.
  virtual std::vector<std::vector<std::uint8_t>> encode(std::span<const SpiFrame> frames) const = 0;
  /// Bytes behind each answer by which a loss of bytes shows.
  virtual std::size_t mark_bytes() const = 0;
  /// Whether these are such bytes.
  virtual bool is_mark(Bytes bytes) const = 0;
  /// Appends what the sensor said of an IN transfer to `out`, marks included.
  virtual void decode(Bytes transfer, std::vector<std::uint8_t>& out) const = 0;
};

/// USB identities of the bridges that make_bridge() knows.
inline constexpr usb::Id kFt232hId{0x0403, 0x6014};
inline constexpr usb::Id kCp2130Id{0x10c4, 0x87a0};

/// The bridge of that identity. Precondition: one of the above.
std::unique_ptr<SpiBridge> make_bridge(usb::Id id);

}  // namespace imunoise::drivers::adis16405
