#include "drivers/xsens/codec/frame.h"

#include <cassert>
#include <numeric>

namespace imunoise::drivers {
namespace {

constexpr std::uint8_t kPreamble = 0xfa;
constexpr std::uint8_t kBusId = 0xff;
constexpr std::uint8_t kExtended = 0xff;

std::uint8_t sum(Bytes bytes) {
  return static_cast<std::uint8_t>(std::accumulate(bytes.begin(), bytes.end(), 0U));
}

}  // namespace

std::vector<std::uint8_t> encode_xbus_frame(std::uint8_t message_id, Bytes payload) {
  assert(payload.size() <= kXbusMaximumPayload);
  std::vector<std::uint8_t> out = {kPreamble, kBusId, message_id};
  if (payload.size() < kExtended) {
    out.push_back(static_cast<std::uint8_t>(payload.size()));
  } else {
    out.push_back(kExtended);
    append_big_endian(out, static_cast<std::uint16_t>(payload.size()));
  }
  out.insert(out.end(), payload.begin(), payload.end());
  out.push_back(static_cast<std::uint8_t>(0U - sum(Bytes(out).subspan(1))));
  return out;
}

void XbusParser::push(Bytes bytes) {
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(begin_));
  begin_ = 0;
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
}

void XbusParser::refuse(Refusal reason) {
  refused_.add(reason);
  ++begin_;
}

std::optional<XbusFrame> XbusParser::next() {
  while (begin_ < buffer_.size()) {
    const Bytes rest = Bytes(buffer_).subspan(begin_);
    if (rest[0] != kPreamble || (rest.size() > 1 && rest[1] != kBusId)) {
      refuse(Refusal::kOutsideMessages);
      continue;
    }
    const bool extended = rest.size() > 3 && rest[3] == kExtended;
    const std::size_t header = extended ? 6 : 4;
    std::size_t size = header + 1;
    if (rest.size() >= header) {
      const std::size_t payload =
          extended ? static_cast<std::size_t>(rest[4]) << 8U | rest[5] : std::size_t{rest[3]};
      if (payload > kXbusMaximumPayload) {
        refuse(Refusal::kLength);
        continue;
      }
      size += payload;
    }
    if (rest.size() < size) {
      if (!finished_) return std::nullopt;
      refuse(Refusal::kTruncated);
      continue;
    }
    if (sum(rest.subspan(1, size - 1)) != 0) {
      refuse(Refusal::kChecksum);
      continue;
    }
    begin_ += size;
    return XbusFrame{rest[2], rest.subspan(header, size - header - 1)};
  }
  return std::nullopt;
}

}  // namespace imunoise::drivers
