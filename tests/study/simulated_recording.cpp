#include "tests/study/simulated_recording.h"

#include <gtest/gtest.h>

#include "core/model/model.h"
#include "recording/store/recorder.h"

namespace imunoise::testing {
namespace {

constexpr Hertz kRate{100.0};
constexpr std::int64_t kPeriod = 10'000'000;  // ns

std::vector<double> values_of(const SimulatedRecording& what, std::size_t channel,
                              std::uint32_t replicate) {
  const std::string& model = what.channels[channel].model;
  if (model.empty()) return std::vector<double>(what.samples, 1.0);
  return simulate(parse_model(model, kRate).value(), what.samples, 1000 * what.seed + channel,
                  replicate);
}

}  // namespace

void record(const SimulatedRecording& what) {
  v1::RecordedDevice device;
  device.set_name(what.device);
  device.set_driver("simulated");
  device.set_serial(what.serial);
  v1::RecordedStream& stream = *device.add_streams();
  stream.set_name("imu");
  stream.set_rate_hz(kRate.value);
  for (const SimulatedChannel& channel : what.channels) {
    v1::RecordedChannel& to = *stream.add_channels();
    to.set_name(channel.name);
    to.set_dtype("<f8");
    to.set_units(channel.unit);
  }
  for (std::uint32_t i = 0; i < what.replicates; ++i) {
    const std::uint32_t k = what.first_replicate + i;
    auto recorder = recording::Recorder::start(recording::posix_file_system(), what.folder,
                                               {"simulated", k, what.started_ns, {device}});
    ASSERT_TRUE(recorder) << recorder.error().message;
    recording::Block block{0, recording::empty_rows(stream)};
    for (std::size_t t = 0; t < what.samples; ++t) {
      block.rows.host_time.push_back(what.started_ns + static_cast<std::int64_t>(t) * kPeriod);
      block.rows.flags.push_back(0);
    }
    for (std::size_t c = 0; c < what.channels.size(); ++c)
      block.rows.channels[c] = values_of(what, c, k);
    block.rows.received = what.samples;
    const auto pushed = (*recorder)->push(0, block);
    ASSERT_TRUE(pushed) << pushed.error().message;
    const auto closed = (*recorder)->close();
    ASSERT_TRUE(closed) << closed.error().message;
  }
}

}  // namespace imunoise::testing
