#include "drivers/host/block.h"

#include <algorithm>
#include <utility>

namespace imunoise::drivers {
namespace {

std::size_t widest(const DeviceInfo& device) {
  std::size_t out = 0;
  for (const Stream& stream : device.streams) out = std::max(out, stream.channels.size());
  return out;
}

}  // namespace

SampleBlock::SampleBlock(std::shared_ptr<const DeviceInfo> device, std::size_t rows)
    : device_(std::move(device)),
      host_time_ns_(rows),
      device_time_ns_(rows),
      counter_(rows),
      flags_(rows),
      numbers_(rows * widest(*device_)),
      columns_(widest(*device_)),
      refused_(columns_.size() * IMUNOISE_REFUSED_REASONS),
      table_(std::make_unique<imunoise_block>()) {
  assert(rows > 0 && rows <= UINT32_MAX);
  for (std::size_t c = 0; c < columns_.size(); ++c) columns_[c] = numbers_.data() + c * rows;
  *table_ = {sizeof(imunoise_block),
             static_cast<std::uint32_t>(rows),
             static_cast<std::uint32_t>(columns_.size()),
             IMUNOISE_REFUSED_REASONS,
             host_time_ns_.data(),
             device_time_ns_.data(),
             counter_.data(),
             flags_.data(),
             columns_.data(),
             refused_.data(),
             0,
             0};
}

imunoise_block& SampleBlock::prepare() {
  std::fill(refused_.begin(), refused_.end(), 0);
  table_->stream = 0;
  table_->rows = 0;
  return *table_;
}

bool SampleBlock::any_refused() const {
  return std::any_of(refused_.begin(), refused_.end(), [](std::uint64_t n) { return n > 0; });
}

}  // namespace imunoise::drivers
