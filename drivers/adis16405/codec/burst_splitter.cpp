#include "drivers/adis16405/codec/burst_splitter.h"

namespace imunoise::drivers::adis16405 {

void BurstSplitter::push(Bytes bytes) {
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(begin_));
  begin_ = 0;
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
}

std::optional<Bytes> BurstSplitter::next() {
  if (buffer_.size() - begin_ >= kBurstBytes) {
    const Bytes out = Bytes(buffer_).subspan(begin_, kBurstBytes);
    begin_ += kBurstBytes;
    return out;
  }
  if (finished_ && begin_ < buffer_.size()) {
    refused_.add(Refusal::kTruncated);
    begin_ = buffer_.size();
  }
  return std::nullopt;
}

}  // namespace imunoise::drivers::adis16405
