#pragma once

// A CP2130 that transfers both ways. Sources: bloguetronica and rust-driver-cp2130.

#include <deque>

#include "drivers/emulator/usb/usb_peripheral.h"

namespace imunoise::emulator {

class Cp2130 final : public UsbPeripheral {
 public:
  /// Borrows the sensor, which hangs on channel 0.
  Cp2130(SpiSlave& sensor, std::string serial);

  const UsbIdentity& identity() const override { return identity_; }
  void power_up() override;
  bool control(const drivers::usb::Request& request) override;
  std::size_t out(drivers::Bytes bytes) override;
  std::optional<std::vector<std::uint8_t>> in() override;
  Time now() const override { return now_; }
  void run(Time until) override;

 private:
  bool transfer();

  SpiSlave& sensor_;
  UsbIdentity identity_;
  bool mode3_ = false;
  bool selects_ = false;
  Hertz clock_{12e6};
  std::deque<std::uint8_t> commands_;
  std::vector<std::uint8_t> answers_;
  Time now_{};
};

}  // namespace imunoise::emulator
