#pragma once

// A port of the kernel's vhci_hcd with a cable to an emulated device: every program then sees it as
// a USB device that is plugged in. Protocol: USB/IP (Documentation/usb/usbip_protocol.rst of
// Linux), served over a socket pair, without a network.

#include <chrono>
#include <cstdint>
#include <deque>
#include <mutex>
#include <thread>
#include <vector>

#include "drivers/emulator/usb/usb_answers.h"

namespace imunoise::testing {

/// In real time, in a thread of its own. Look at the device, and change it, with lock() held. Needs
/// the module vhci_hcd and permission to write its `attach` (root). Thread-safe.
class UsbIpPort {
 public:
  /// Borrows the peripheral, and plugs it in at this port of the first controller (0 to 7). Throws
  /// std::system_error.
  UsbIpPort(emulator::UsbPeripheral& peripheral, unsigned port);
  UsbIpPort(const UsbIpPort&) = delete;
  UsbIpPort& operator=(const UsbIpPort&) = delete;
  ~UsbIpPort();

  std::unique_lock<std::mutex> lock() { return std::unique_lock(mutex_); }

  void unplug();
  void plug();
  /// The kernel gets no answer for so long; then it gets all at once.
  void hold_up(emulator::Time duration);
  void halt_in();
  void lose_byte();
  /// Transfers that the kernel submitted since construction.
  std::uint64_t transfers();

 private:
  using Clock = std::chrono::steady_clock;
  struct Answer {
    std::uint32_t sequence = 0;
    bool unlink = false;
    std::int32_t status = 0;
    std::size_t actual = 0;
    std::vector<std::uint8_t> bytes;
  };

  void serve(int socket, const std::stop_token& stop);
  bool take_messages(int socket);
  bool take_message(int socket);
  void let_time_pass();
  void answer(emulator::UsbAnswers::Completed completed);
  bool send_answers(int socket);

  emulator::UsbPeripheral& peripheral_;
  unsigned port_;
  std::mutex mutex_;
  emulator::UsbAnswers answers_;
  std::uint64_t transfers_ = 0;
  Clock::time_point plugged_{};
  Clock::time_point held_until_{};
  std::deque<Answer> to_send_;
  std::jthread thread_;
};

}  // namespace imunoise::testing
