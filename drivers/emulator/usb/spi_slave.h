#pragma once

// A sensor as a USB-SPI bridge sees it, in time that the bridge tells.

#include <chrono>
#include <cstdint>

#include "core/support/units.h"

namespace imunoise::emulator {

/// Since power was applied. Emulated: without real waiting.
using Time = std::chrono::nanoseconds;

/// Times never decrease from call to call.
class SpiSlave {
 public:
  SpiSlave() = default;
  SpiSlave(const SpiSlave&) = delete;
  SpiSlave& operator=(const SpiSlave&) = delete;
  virtual ~SpiSlave() = default;

  /// Power fails and comes back at time 0.
  virtual void power_up() = 0;
  /// Chip select falls. `clock_high`: the level of the clock then; mode 3 wants it high.
  virtual void select(Time now, bool clock_high) = 0;
  /// One byte both ways, beginning now, read on rising edges and driven on falling ones.
  virtual std::uint8_t exchange(std::uint8_t byte, Time now, Hertz clock) = 0;
  /// Chip select rises.
  virtual void deselect(Time now) = 0;
  /// Level of the data-ready line.
  virtual bool data_ready(Time now) = 0;
  /// When that level changes next, after `now`; Time::max(): never.
  virtual Time next_change(Time now) = 0;
};

}  // namespace imunoise::emulator
