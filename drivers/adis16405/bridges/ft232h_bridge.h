#pragma once

#include "drivers/adis16405/bridges/spi_bridge.h"

namespace imunoise::drivers::adis16405 {

/// FT232H: high-speed USB, MPSSE engine, data-ready on GPIOL1 (ADBUS5). All frames that are sent
/// together travel in one transfer. Requests: pyftdi and flashrom.
class Ft232hBridge final : public SpiBridge {
 public:
  std::string_view name() const override { return "FT232H"; }
  bool sees_data_ready() const override { return true; }
  void start(usb::Handle& usb, Hertz clock) override;
  std::vector<std::vector<std::uint8_t>> encode(std::span<const SpiFrame> frames) const override;
  std::size_t mark_bytes() const override { return 1; }
  bool is_mark(Bytes bytes) const override;
  void decode(Bytes transfer, std::vector<std::uint8_t>& out) const override;

 private:
  void synchronise(usb::Handle& usb) const;

  Hertz clock_;
};

}  // namespace imunoise::drivers::adis16405
