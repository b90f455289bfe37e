#pragma once

#include "drivers/adis16405/bridges/spi_bridge.h"

namespace imunoise::drivers::adis16405 {

/// CP2130: full-speed USB, knows mode 3, cannot wait for data-ready. The sensor hangs on channel 0.
/// One transfer a frame; the way through USB is its pause.
class Cp2130Bridge final : public SpiBridge {
 public:
  std::string_view name() const override { return "CP2130"; }
  bool sees_data_ready() const override { return false; }
  void start(usb::Handle& usb, Hertz clock) override;
  std::vector<std::vector<std::uint8_t>> encode(std::span<const SpiFrame> frames) const override;
  std::size_t mark_bytes() const override { return 0; }
  bool is_mark(Bytes /*bytes*/) const override { return true; }
  void decode(Bytes transfer, std::vector<std::uint8_t>& out) const override;
};

}  // namespace imunoise::drivers::adis16405
