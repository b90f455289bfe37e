#include "drivers/xsens/codec/decoder.h"

#include <utility>

#include "drivers/xsens/codec/messages.h"

namespace imunoise::drivers {
bool XbusDecoder::next(DecodedSample& sample) {
  bool found = false;
  while (!found) {
    const std::optional<XbusFrame> frame = parser_.next();
    if (!frame) break;
    found = decode(*frame, sample);
  }
  tally_.refused = parser_.refused();
  tally_.refused += own_;
  if (found) ++tally_.samples;
  return found;
}

bool XbusDecoder::decode(const XbusFrame& frame, DecodedSample& sample) {
  switch (static_cast<XsensMessage>(frame.message_id)) {
    case XsensMessage::kMtData2:
      decode_mtdata2(frame.payload, data2_, own_);
      std::swap(sample, data2_.sample);
      if (data2_.packet_counter) count(*data2_.packet_counter, sample);
      if (data2_.sample_time_fine) {
        sample.clock = Clock::kDevice;
        sample.time_ns = clock_(*data2_.sample_time_fine);
      }
      return true;
    case XsensMessage::kMtData:
      return decode_mtdata(frame.payload, sample);
    case XsensMessage::kConfiguration:
      if (const auto configuration = decode_configuration(frame.payload)) {
        layout_ = configuration->layout;
        ++tally_.other_messages;
      } else {
        own_.add(Refusal::kLength);
      }
      return false;
    case XsensMessage::kError:
      own_.add(Refusal::kDeviceError);
      return false;
    default:
      ++tally_.other_messages;
      return false;
  }
}

bool XbusDecoder::decode_mtdata(Bytes payload, DecodedSample& sample) {
  if (!layout_) {
    own_.add(Refusal::kNoLayout);
    return false;
  }
  if (!decode_legacy(payload, *layout_, data_, own_)) return false;
  std::swap(sample, data_.sample);
  if (data_.counter) count(*data_.counter, sample);
  return true;
}

void XbusDecoder::count(std::uint16_t raw, DecodedSample& sample) {
  const std::int64_t now = counter_(raw);
  if (last_count_ && now > *last_count_ + 1) {
    tally_.lost += static_cast<std::uint64_t>(now - *last_count_ - 1);
  }
  last_count_ = now;
  sample.counter = now;
}

}  // namespace imunoise::drivers
