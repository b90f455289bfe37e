#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/support/units.h"
#include "drivers/adis16405/codec/burst.h"
#include "drivers/codec/si_unit.h"
#include "drivers/codec/stream_decoder.h"

namespace imunoise::drivers::adis16405 {

/// Bursts one after the other, 26 bytes each, as a bridge gives them. They hold neither time nor
/// counter: time is nominal, the number of samples before over the configured rate. Flags:
/// "error_alarm" where DIAG_STAT should be read, "old_mag_x" and the like for channels that are not
/// new. Bursts carry no mark to find them by: if bytes were dropped, all that follows is wrong.
class BurstDecoder final : public StreamDecoder {
 public:
  /// From count_scales(SENS_AVG) and sample_rate(SMPL_PRD).
  BurstDecoder(const std::array<CountScale, kBurstChannels>& scales, Hertz rate);

  void push(Bytes bytes) override;
  void finish() override { finished_ = true; }
  bool next(DecodedSample& sample) override;

 private:
  void fill(const Burst& burst, DecodedSample& sample);

  Hertz rate_;
  std::array<SiUnit, kBurstChannels> units_;
  std::vector<std::uint8_t> buffer_;
  std::size_t begin_ = 0;  // bytes before it are done with
  bool finished_ = false;
};

}  // namespace imunoise::drivers::adis16405
