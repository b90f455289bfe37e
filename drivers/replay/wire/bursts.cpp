#include <cmath>

#include "drivers/adis16405/burst_rows.h"
#include "drivers/adis16405/codec/burst_splitter.h"
#include "drivers/replay/wire/codec.h"
#include "drivers/replay/wire/parsed_file.h"

namespace imunoise::replay {
namespace {

using namespace drivers::adis16405;

class BurstCodec final : public WireCodec {
 public:
  BurstCodec(const std::filesystem::path& file, const Settings& settings)
      : settings_(settings), bursts_(file), rows_(false) {}

  drivers::DeviceInfo info() const override { return {describe_streams(settings_), "ADIS16405"}; }

  std::optional<std::int64_t> next() override {
    const auto burst = bursts_.next();
    if (!burst) return std::nullopt;
    burst_ = *burst;
    const double time = static_cast<double>(count_++) / sample_rate(settings_.sample_period).value;
    return std::llround(time * 1e9);
  }

  void take(std::int64_t host_time_ns, plugin::Samples& samples) override {
    rows_.take(burst_, host_time_ns, samples);
  }

 private:
  Settings settings_;
  ParsedFile<BurstSplitter> bursts_;
  BurstRows rows_;
  drivers::Bytes burst_;  // the last one
  std::uint64_t count_ = 0;
};

}  // namespace

std::unique_ptr<WireCodec> open_bursts(const std::filesystem::path& file,
                                       const Settings& settings) {
  return std::make_unique<BurstCodec>(file, settings);
}

}  // namespace imunoise::replay
