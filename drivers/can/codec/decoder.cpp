#include "drivers/can/codec/decoder.h"

#include <algorithm>
#include <utility>

namespace imunoise::drivers {
namespace {

constexpr std::size_t kLongestLine = 512;  // a CAN FD frame with dots needs some 250

}  // namespace

void CandumpDecoder::push(Bytes bytes) {
  buffer_.erase(0, begin_);
  searched_ -= begin_;
  begin_ = 0;
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
}

bool CandumpDecoder::next(DecodedSample& sample) {
  while (true) {
    std::size_t end = buffer_.find('\n', searched_);
    const bool open = end == std::string::npos;
    if (open) {
      searched_ = buffer_.size();
      if (finished_ && begin_ < buffer_.size()) {
        end = buffer_.size();
      } else {
        if (!too_long_ && searched_ - begin_ > kLongestLine) {
          refuse_if_frame(std::string_view(buffer_).substr(begin_));
          too_long_ = true;
        }
        if (too_long_) begin_ = searched_;
        return false;
      }
    }
    const std::string_view line = std::string_view(buffer_).substr(begin_, end - begin_);
    begin_ = searched_ = std::min(end + 1, buffer_.size());
    if (std::exchange(too_long_, false)) continue;
    if (decode(line, sample)) return true;
  }
}

void CandumpDecoder::refuse_if_frame(std::string_view line) {
  if (line.starts_with('(')) tally_.refused.add(Refusal::kMalformedLine);
}

bool CandumpDecoder::decode(std::string_view line, DecodedSample& sample) {
  const bool too_long = line.size() > kLongestLine;
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
  const auto seen = too_long ? std::nullopt : parse_candump_line(line);
  if (!seen) {
    refuse_if_frame(line);
    return false;
  }
  switch (channels_.decode(seen->frame, sample, tally_.refused)) {
    case CanChannels::Outcome::kSample:
      break;
    case CanChannels::Outcome::kIgnored:
      ++tally_.other_messages;
      return false;
    case CanChannels::Outcome::kRefused:
      return false;
  }
  sample.source = seen->interface;
  sample.clock = Clock::kHost;
  sample.time_ns = seen->time_ns;
  ++tally_.samples;
  return true;
}

}  // namespace imunoise::drivers
