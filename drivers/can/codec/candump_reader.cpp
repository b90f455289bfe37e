#include "drivers/can/codec/candump_reader.h"

#include <algorithm>
#include <utility>

namespace imunoise::drivers {
namespace {

constexpr std::size_t kLongestLine = 512;  // a CAN FD frame with dots needs some 250

}  // namespace

void CandumpReader::push(Bytes bytes) {
  buffer_.erase(0, begin_);
  searched_ -= begin_;
  begin_ = 0;
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
}

std::optional<CandumpLine> CandumpReader::next() {
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
        return std::nullopt;
      }
    }
    const std::string_view line = std::string_view(buffer_).substr(begin_, end - begin_);
    begin_ = searched_ = std::min(end + 1, buffer_.size());
    if (std::exchange(too_long_, false)) continue;
    if (auto frame = parse(line)) return frame;
  }
}

std::optional<CandumpLine> CandumpReader::parse(std::string_view line) {
  const bool too_long = line.size() > kLongestLine;
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
  auto frame = too_long ? std::nullopt : parse_candump_line(line);
  if (!frame) refuse_if_frame(line);
  return frame;
}

void CandumpReader::refuse_if_frame(std::string_view line) {
  if (line.starts_with('(')) refused_.add(Refusal::kMalformedLine);
}

}  // namespace imunoise::drivers
