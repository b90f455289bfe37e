// The rates of streams, as listening tells them.

#include "drivers/can/frame_streams.h"

#include <gtest/gtest.h>

#include "drivers/can/codec/presets.h"

namespace imunoise::can {
namespace {

// Angular rates of a Movella MTi 600.
drivers::CanFrame angular_rates() {
  drivers::CanFrame out;
  out.id = 0x32;
  out.length = 6;
  return out;
}

// The rate that imunoise takes from one second of frames at 100 Hz. The first `late` frames waited
// in a queue and came together.
double rate_heard(int late) {
  const drivers::CanChannels channels = *drivers::make_preset("mti600");
  FrameStreams streams = *FrameStreams::make(channels);
  constexpr std::int64_t kPeriod = 10'000'000;
  for (std::int64_t i = 0; i < 100; ++i)
    streams.hear(angular_rates(), std::max<std::int64_t>(i, late) * kPeriod);
  EXPECT_TRUE(streams.settle({}, 1.0).empty());
  EXPECT_EQ(streams.streams().size(), 1U);
  return streams.descriptions().at(0).nominal_rate_hz;
}

TEST(FrameStreams, TellTheRate) { EXPECT_EQ(rate_heard(0), 100.0); }

TEST(FrameStreams, FramesThatWaitedDoNotRaiseTheRate) { EXPECT_EQ(rate_heard(4), 100.0); }

}  // namespace
}  // namespace imunoise::can
