#pragma once

#include <utility>

#include "drivers/can/codec/candump_reader.h"
#include "drivers/can/codec/channels.h"
#include "drivers/codec/stream_decoder.h"

namespace imunoise::drivers {

/// The text of candump -L in, samples out. Time is the host's.
class CandumpDecoder final : public StreamDecoder {
 public:
  explicit CandumpDecoder(CanChannels channels) : channels_(std::move(channels)) {}

  void push(Bytes bytes) override { lines_.push(bytes); }
  void finish() override { lines_.finish(); }
  bool next(DecodedSample& sample) override;

 private:
  bool decode(const CandumpLine& line, DecodedSample& sample);

  CanChannels channels_;
  CandumpReader lines_;
  Refusals own_;  // what was refused within frames
};

}  // namespace imunoise::drivers
