#include "tests/recording/simulated_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "recording/store/recorder/recorder.h"

namespace imunoise::testing {
namespace {

v1::RecordedDevice described(const BenchDevice& from) {
  v1::RecordedDevice out;
  out.set_name(from.name);
  out.set_driver("simulated");
  out.set_serial(from.serial);
  v1::RecordedStream& stream = *out.add_streams();
  stream.set_name("imu");
  stream.set_rate_hz(from.rate_hz);
  for (const BenchChannel& channel : from.channels) {
    v1::RecordedChannel& to = *stream.add_channels();
    to.set_name(channel.name);
    to.set_dtype("<f8");
    to.set_units(channel.unit);
  }
  return out;
}

recording::Rows rows_of(const BenchDevice& from, const v1::RecordedStream& stream,
                        std::int64_t started_ns, std::uint32_t seed) {
  recording::Rows out = recording::empty_rows(stream);
  std::mt19937_64 random(seed);
  std::exponential_distribution<double> late(1.0);
  for (std::size_t i = 0; i < from.samples; ++i) {
    const double seconds =
        from.after_s + static_cast<double>(i) / from.rate_hz * (1.0 - 1e-6 * from.ppm);
    const double came = seconds + (from.late_s > 0.0 ? from.late_s * late(random) : 0.0);
    out.host_time.push_back(started_ns + std::llround(came * 1e9));
    out.flags.push_back(0);
    for (std::size_t c = 0; c < from.channels.size(); ++c) {
      std::get<std::vector<double>>(out.channels[c]).push_back(from.channels[c].value(i, seconds));
    }
  }
  out.received = from.samples;
  return out;
}

}  // namespace

void record_bench(const std::filesystem::path& folder, std::uint32_t replicate,
                  std::int64_t started_ns, const std::vector<BenchDevice>& devices) {
  recording::RecordingPlan plan{"simulated", replicate, started_ns, {}};
  for (const BenchDevice& device : devices) plan.devices.push_back(described(device));
  auto recorder = recording::Recorder::start(recording::posix_file_system(), folder, plan);
  ASSERT_TRUE(recorder) << recorder.error().message;
  for (std::size_t d = 0; d < devices.size(); ++d) {
    const recording::Block block{0, rows_of(devices[d], plan.devices[d].streams(0), started_ns,
                                            replicate * 100 + static_cast<std::uint32_t>(d))};
    const auto pushed = (*recorder)->push(d, block);
    ASSERT_TRUE(pushed) << pushed.error().message;
  }
  const auto closed = (*recorder)->close();
  ASSERT_TRUE(closed) << closed.error().message;
}

}  // namespace imunoise::testing
