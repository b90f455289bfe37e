#pragma once

// SPI frames with their answers, through any bridge.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "drivers/adis16405/bridges/spi_bridge.h"

namespace imunoise::drivers::adis16405 {

/// What came back for one frame.
struct SpiAnswer {
  std::vector<std::uint8_t> bytes;
  std::int64_t host_time_ns = 0;  ///< When its USB transfer was complete, ns since 1970-01-01 UTC.
};

/// Queues frames, many ahead, and gives their answers in order. One thread at a time. Throws
/// plugin::DeviceError.
class SpiBus {
 public:
  SpiBus(std::unique_ptr<usb::Handle> usb, std::unique_ptr<SpiBridge> bridge);

  const SpiBridge& bridge() const { return *bridge_; }
  /// Starts the bridge, or gives it another clock. Precondition: no frame waits for its answer.
  void start(Hertz clock);
  /// Queues frames, for one USB transfer where the bridge can. Returns at once.
  void send(std::span<const SpiFrame> frames);
  /// All answers that came, in order. None: not within `timeout`, or already before it is over.
  /// Throws DISCONNECTED where bytes were lost on the way: what follows them has no meaning.
  std::vector<SpiAnswer> receive(usb::Duration timeout);

  usb::Duration now() const { return usb_->now(); }
  void sleep(usb::Duration duration) { usb_->sleep(duration); }

 private:
  void cut(std::int64_t host_time_ns, std::vector<SpiAnswer>& answers);

  std::unique_ptr<usb::Handle> usb_;
  std::unique_ptr<SpiBridge> bridge_;
  std::deque<std::size_t> expected_;  // lengths of answers
  bool lost_bytes_ = false;
  std::vector<std::uint8_t> came_;  // of answers that are not whole yet
};

}  // namespace imunoise::drivers::adis16405
