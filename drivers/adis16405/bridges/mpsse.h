#pragma once

// SPI mode 3 through the MPSSE engine of an FT232H, which does not know that mode: the clock idles
// high by setting pins around each transfer (libmpsse's method). Pins: SK, DO, DI, CS, and the
// data- ready line on GPIOL1. Sources: pyftdi, flashrom and libmpsse for the opcodes; the
// composition has not met hardware yet.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/support/units.h"
#include "drivers/codec/bytes.h"

namespace imunoise::drivers::adis16405 {

/// A wrong opcode and its answer: proof that the engine listens and that nothing else is queued.
inline constexpr std::uint8_t kMpsseBadOpcode = 0xaa;
inline constexpr std::uint8_t kMpsseBadOpcodeAnswer = 0xfa;

/// Bytes of one bulk IN packet at high speed, and of the modem status in front of each.
inline constexpr std::size_t kFtdiPacketBytes = 512;
inline constexpr std::size_t kFtdiStatusBytes = 2;

/// Engine at 60 MHz, no adaptive clock, no three-phase clock, no loopback, the SPI clock at most
/// `clock`, lines idle. Precondition: 458 Hz to 30 MHz.
std::vector<std::uint8_t> mpsse_setup(Hertz clock);

/// Appends one mode 3 transfer: the bytes of `send` go out, as many come back. With `on_data_ready`
/// the engine first waits for a rising edge of GPIOL1 (and only a reset of the engine ends the
/// wait). Precondition: 1 to 65536 bytes.
void append_mpsse_transfer(std::vector<std::uint8_t>& out, Bytes send, bool on_data_ready);

/// Appends a question for the levels of the pins: one byte comes back.
void append_mpsse_mark(std::vector<std::uint8_t>& out);
/// Whether that byte is what idle lines give. Where bytes were lost before it, it is another byte.
bool is_mpsse_mark(std::uint8_t byte);

/// Appends: what has come back goes to the host now, though it fills no packet.
void append_mpsse_flush(std::vector<std::uint8_t>& out);

/// Appends a pause of at least `least` between two transfers, as cycles of a clock of `clock` that
/// nothing listens to.
void append_mpsse_pause(std::vector<std::uint8_t>& out, std::chrono::microseconds least,
                        Hertz clock);

/// Appends what an IN transfer carries to `out`, without the two status bytes of each packet.
void strip_ftdi_status(Bytes transfer, std::vector<std::uint8_t>& out);

}  // namespace imunoise::drivers::adis16405
