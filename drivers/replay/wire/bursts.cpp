#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "drivers/adis16405/burst_rows.h"
#include "drivers/replay/wire/byte_file.h"
#include "drivers/replay/wire/codec.h"

namespace imunoise::replay {
namespace {

using namespace drivers::adis16405;

class BurstCodec final : public WireCodec {
 public:
  BurstCodec(const std::filesystem::path& file, const Settings& settings)
      : settings_(settings), file_(file), rows_(false) {}

  drivers::DeviceInfo info() const override { return {describe_streams(settings_), "ADIS16405"}; }

  std::optional<std::int64_t> next() override {
    std::size_t filled = 0;
    while (filled < kBurstBytes) {
      if (left_.empty()) left_ = file_.read();
      if (left_.empty()) return std::nullopt;  // what is not whole is no burst
      const std::size_t count = std::min(left_.size(), kBurstBytes - filled);
      std::memcpy(burst_.data() + filled, left_.data(), count);
      left_ = left_.subspan(count);
      filled += count;
    }
    const double time = static_cast<double>(count_++) / sample_rate(settings_.sample_period).value;
    return std::llround(time * 1e9);
  }

  void take(std::int64_t host_time_ns, plugin::Samples& samples) override {
    rows_.take(burst_, host_time_ns, samples);
  }

 private:
  Settings settings_;
  ByteFile file_;
  BurstRows rows_;
  drivers::Bytes left_;  // of what the file gave last
  std::array<std::uint8_t, kBurstBytes> burst_{};
  std::uint64_t count_ = 0;
};

}  // namespace

std::unique_ptr<WireCodec> open_bursts(const std::filesystem::path& file,
                                       const Settings& settings) {
  return std::make_unique<BurstCodec>(file, settings);
}

}  // namespace imunoise::replay
