#pragma once

// SPI through a CP2130, which knows mode 3. Sources: bloguetronica and rust-driver-cp2130, which
// agree. Control requests during a bulk transfer hang the chip: configure only while it is idle.

#include <array>
#include <cstdint>
#include <vector>

#include "core/support/units.h"
#include "drivers/codec/bytes.h"

namespace imunoise::drivers::adis16405 {

/// A vendor request from host to device; wValue and wIndex are zero.
struct Cp2130Request {
  std::uint8_t request = 0;
  std::vector<std::uint8_t> data;
  friend bool operator==(const Cp2130Request&, const Cp2130Request&) = default;
};

/// Set_SPI_Word: mode 3, chip select driven both ways, the fastest clock of the chip (12 MHz / 2^n,
/// n = 0..7) that is not above `clock`. Precondition: at least 93.75 kHz.
Cp2130Request cp2130_spi_word(std::uint8_t channel, Hertz clock);

/// Set_GPIO_Chip_Select: this channel's line alone takes part in transfers.
Cp2130Request cp2130_select_only(std::uint8_t channel);

/// Set_SPI_Delay: no pauses between bytes or around chip select.
Cp2130Request cp2130_no_delays(std::uint8_t channel);

/// What goes to bulk OUT for a transfer of `send` both ways; as many bytes come back by bulk IN.
std::vector<std::uint8_t> cp2130_write_read(Bytes send);

}  // namespace imunoise::drivers::adis16405
