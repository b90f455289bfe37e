#pragma once

#include <optional>

#include "drivers/codec/stream_decoder.h"
#include "drivers/codec/unwrap.h"
#include "drivers/xsens/codec/frame.h"
#include "drivers/xsens/codec/legacy.h"
#include "drivers/xsens/codec/mtdata2.h"
#include "drivers/xsens/codec/sample_clock.h"

namespace imunoise::drivers {

/// Xbus bytes in, samples out: MTData2, and legacy MTData once a Configuration message has said its
/// layout.
class XbusDecoder final : public StreamDecoder {
 public:
  void push(Bytes bytes) override { parser_.push(bytes); }
  void finish() override { parser_.finish(); }
  bool next(DecodedSample& sample) override;

 private:
  bool decode(const XbusFrame& frame, DecodedSample& sample);
  bool decode_mtdata(Bytes payload, DecodedSample& sample);
  void count(std::uint16_t raw, DecodedSample& sample);

  XbusParser parser_;
  MtData2 data2_;
  LegacyData data_;
  std::optional<LegacyLayout> layout_;
  Unwrapper counter_{65536};
  std::optional<std::int64_t> last_count_;
  XsensSampleClock clock_;
  Refusals own_;  // what was refused within whole frames
};

}  // namespace imunoise::drivers
