#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "drivers/can/codec/candump.h"
#include "drivers/can/codec/channels.h"
#include "drivers/codec/stream_decoder.h"

namespace imunoise::drivers {

/// The text of candump -L in, samples out. Time is the host's. Lines that do not begin with "(" are
/// passed over without a word; those that do and are no frame are refused.
class CandumpDecoder final : public StreamDecoder {
 public:
  explicit CandumpDecoder(CanChannels channels) : channels_(std::move(channels)) {}

  void push(Bytes bytes) override;
  void finish() override { finished_ = true; }
  bool next(DecodedSample& sample) override;

 private:
  bool decode(std::string_view line, DecodedSample& sample);
  void refuse_if_frame(std::string_view line);

  CanChannels channels_;
  std::string buffer_;
  std::size_t begin_ = 0;     // characters before it are done with
  std::size_t searched_ = 0;  // no line ends before it
  bool too_long_ = false;     // within a line that was refused for its length
  bool finished_ = false;
};

}  // namespace imunoise::drivers
