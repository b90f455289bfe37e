#pragma once

#include <array>

#include "core/support/units.h"
#include "drivers/adis16405/codec/burst.h"
#include "drivers/adis16405/codec/burst_splitter.h"
#include "drivers/codec/si_unit.h"
#include "drivers/codec/stream_decoder.h"

namespace imunoise::drivers::adis16405 {

/// Bursts one after the other, 26 bytes each, as a bridge gives them. They hold neither time nor
/// counter: time is nominal, the number of samples before over the configured rate. Flags:
/// "error_alarm" where DIAG_STAT should be read, "old_mag_x" and the like for channels that are not
/// new.
class BurstDecoder final : public StreamDecoder {
 public:
  /// From count_scales(SENS_AVG) and sample_rate(SMPL_PRD).
  BurstDecoder(const std::array<CountScale, kBurstChannels>& scales, Hertz rate);

  void push(Bytes bytes) override { bursts_.push(bytes); }
  void finish() override { bursts_.finish(); }
  bool next(DecodedSample& sample) override;

 private:
  void fill(const Burst& burst, DecodedSample& sample);

  Hertz rate_;
  std::array<SiUnit, kBurstChannels> units_;
  BurstSplitter bursts_;
  Refusals own_;  // whole bursts that are no sample
};

}  // namespace imunoise::drivers::adis16405
