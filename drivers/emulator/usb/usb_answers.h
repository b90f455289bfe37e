#pragma once

// What a USB device answers to a kernel: descriptors, standard requests, and the transfers of its
// two bulk endpoints. USB 2.0 specification, chapters 5 and 9.

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "drivers/emulator/usb/usb_peripheral.h"

namespace imunoise::emulator {

inline constexpr std::size_t kSetupBytes = 8;
/// The first packet of a control transfer.
using UsbSetup = std::array<std::uint8_t, kSetupBytes>;

std::vector<std::uint8_t> device_descriptor(const UsbIdentity& identity);
/// Configuration, its one interface, two bulk endpoints.
std::vector<std::uint8_t> configuration_descriptor(const UsbIdentity& identity);

/// Takes a byte from the end of a packet that holds an answer. False: it holds none.
bool lose_byte_of(std::vector<std::uint8_t>& packet);

/// The transfers that a kernel has submitted. Not thread-safe.
class UsbAnswers {
 public:
  using Id = std::uint64_t;
  struct Completed {
    Id id = 0;
    bool stalled = false;
    std::size_t sent = 0;                ///< Bytes that went to the device.
    std::vector<std::uint8_t> received;  ///< Bytes that came from it.
  };

  /// Borrows the peripheral.
  explicit UsbAnswers(UsbPeripheral& peripheral) : peripheral_(peripheral) {}

  /// A control transfer, at once. `data`: what goes with it to the device.
  Completed control(Id id, const UsbSetup& setup, drivers::Bytes data);
  void submit_out(Id id, std::vector<std::uint8_t> bytes) {
    out_.push_back({id, std::move(bytes)});
  }
  void submit_in(Id id) { in_.push_back(id); }
  /// False: it is not, or no longer, here.
  bool discard(Id id);
  /// All transfers, which end without a result.
  std::vector<Id> discard_all();

  /// Lets the device do one thing, or wait until `end`.
  void pass(Time end, std::vector<Completed>& completed);
  /// Moves what the device has room for, and what it has ready.
  void exchange(std::vector<Completed>& completed);

  bool idle() const { return in_.empty() && out_.empty(); }
  bool nothing_to_send() const { return out_.empty(); }

  /// The IN endpoint halts: its transfers fail until the host clears it.
  void halt_in() { in_halted_ = true; }
  /// The next packet with an answer loses a byte of it.
  void lose_byte() { loses_byte_ = true; }

 private:
  struct Out {
    Id id = 0;
    std::vector<std::uint8_t> bytes;
    std::size_t done = 0;
  };

  std::optional<std::vector<std::uint8_t>> answer(const UsbSetup& setup, drivers::Bytes data);

  UsbPeripheral& peripheral_;
  std::deque<Id> in_;
  std::deque<Out> out_;
  bool in_halted_ = false;
  bool loses_byte_ = false;
};

}  // namespace imunoise::emulator
