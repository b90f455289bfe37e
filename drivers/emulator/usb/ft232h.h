#pragma once

// An FT232H in MPSSE mode. Sources: pyftdi, flashrom.

#include "drivers/emulator/usb/mpsse_engine.h"
#include "drivers/emulator/usb/usb_peripheral.h"

namespace imunoise::emulator {

class Ft232h final : public UsbPeripheral {
 public:
  /// Borrows the sensor.
  Ft232h(SpiSlave& sensor, std::string serial);

  const UsbIdentity& identity() const override { return identity_; }
  void power_up() override;
  bool control(const drivers::usb::Request& request) override;
  std::size_t out(drivers::Bytes bytes) override;
  std::optional<std::vector<std::uint8_t>> in() override;
  Time now() const override { return now_; }
  void run(Time until) override;

 private:
  bool packet_ready() const;

  SpiSlave& sensor_;
  UsbIdentity identity_;
  MpsseEngine engine_;
  bool mpsse_ = false;
  Time latency_{};
  Time now_{};
  Time last_packet_{};
};

}  // namespace imunoise::emulator
