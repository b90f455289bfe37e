// What the driver delivers while things go wrong, against what the sensor took and sent.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/drivers/adis16405/rig.h"

namespace imunoise::testing {
namespace {

using namespace std::chrono_literals;
using drivers::ReadOutcome;

constexpr std::array kStreams = {kImu, kMagnetometer, kHousekeeping};

// An open device with some samples read, and what was received until then forgotten.
struct Running : Rig {
  explicit Running(drivers::usb::Id bridge_id = drivers::adis16405::kFt232hId) : Rig(bridge_id) {
    open();
    EXPECT_EQ(read(300), ReadOutcome::kSamples);
    for (const Stream stream : kStreams) received[stream] = {};
  }
};

TEST(Adis16405Faults, StaleBurstsAreRefusedAndCounted) {
  Running rig;
  rig.sensor.faults.stale_every = 7;
  ASSERT_EQ(rig.read(3000), ReadOutcome::kSamples);
  for (const Stream stream : kStreams) {
    const Received& got = rig.received[stream];
    expect_stretch(got.rows, rig.taken(stream));
    // Every seventh data-ready brings nothing; the sample after it follows a gap.
    EXPECT_NEAR(static_cast<double>(got.refused[IMUNOISE_REFUSED_STALE]), 3000.0 / 6.0, 1.0);
    EXPECT_NEAR(static_cast<double>(got.flagged(IMUNOISE_SAMPLE_AFTER_GAP)), 3000.0 / 6.0, 1.0);
  }
}

// A burst as its words were on the wire: what the datasheet says of them, by hand.
struct Words {
  Counts counts;
  bool all_new = true;
  bool any_new = false;
  bool alarm = false;
};

Words read_words(const emulator::SentBurst& burst, Stream stream) {
  Words out;
  for (const std::size_t position : kPositions[stream]) {
    const unsigned upper = burst.bytes[2 + 2 * position];
    const unsigned word = upper << 8U | burst.bytes[3 + 2 * position];
    const bool narrow = position >= 10;                     // 12 bits
    const bool positive = position == 0 || position == 11;  // supply, auxiliary input
    const unsigned modulus = narrow ? 1U << 12U : 1U << 14U;
    const int value = static_cast<int>(word % modulus);
    const bool negative = !positive && value >= static_cast<int>(modulus / 2);
    out.counts.push_back(
        static_cast<std::int16_t>(negative ? value - static_cast<int>(modulus) : value));
    out.all_new = out.all_new && (word & 0x8000U) != 0;
    out.any_new = out.any_new || (word & 0x8000U) != 0;
    out.alarm = out.alarm || (word & 0x4000U) != 0;
  }
  return out;
}

TEST(Adis16405Faults, BitErrorsSpoilTheirSampleAlone) {
  Running rig;
  rig.sensor.faults.bit_error_rate = 0.02;
  ASSERT_EQ(rig.read(4000), ReadOutcome::kSamples);
  for (const Stream stream : kStreams) {
    const Received& got = rig.received[stream];
    std::vector<Counts> whole;
    std::vector<std::size_t> broken;  // stands before this one of `whole`
    for (const emulator::SentBurst& burst : rig.sensor.sent()) {
      const Words words = read_words(burst, stream);
      if (words.all_new) whole.push_back(words.counts);
      if (!words.all_new && words.any_new) broken.push_back(whole.size());
    }
    const std::size_t first = expect_stretch(got.rows, whole);
    const auto in_reach = std::count_if(broken.begin(), broken.end(), [&](std::size_t before) {
      return before >= first && before < first + got.rows.size();
    });
    EXPECT_GT(in_reach, 20) << "too few errors: the test shows nothing";
    EXPECT_EQ(got.refused[IMUNOISE_REFUSED_MALFORMED], static_cast<std::uint64_t>(in_reach));
    for (const std::size_t before : broken) {
      if (before < first || before >= first + got.rows.size()) continue;
      EXPECT_NE(got.flags[before - first] & IMUNOISE_SAMPLE_AFTER_GAP, 0U) << before;
    }
  }
}

TEST(Adis16405Faults, AStallIsEndedByAnotherStart) {
  Running rig;
  rig.sensor.faults.stalled = true;
  const std::size_t before = rig.received[kImu].rows.size();
  ASSERT_EQ(rig.read(500), ReadOutcome::kSamples);
  EXPECT_TRUE(rig.noted("no sample for 1 s"));
  EXPECT_FALSE(rig.sensor.faults.stalled) << "nobody reset the sensor";
  const Received& got = rig.received[kImu];
  ASSERT_GT(got.rows.size(), before);
  EXPECT_LE(expect_in_order(got.rows, rig.taken(kImu)), 1U);
  EXPECT_EQ(got.flagged(IMUNOISE_SAMPLE_AFTER_RESTART), 1U);
}

TEST(Adis16405Faults, ASensorThatDiesIsLookedFor) {
  Running rig;
  rig.sensor.faults.dead = true;
  EXPECT_EQ(rig.read(500), ReadOutcome::kDisconnected);
  EXPECT_NE(rig.device->disconnection().find("no answer"), std::string::npos)
      << rig.device->disconnection();
  rig.sensor.faults.dead = false;
  ASSERT_EQ(rig.read(500), ReadOutcome::kSamples);
  EXPECT_TRUE(rig.noted("is back"));
  EXPECT_EQ(rig.received[kImu].flagged(IMUNOISE_SAMPLE_AFTER_RESTART), 1U);
}

TEST(Adis16405Faults, UnpluggedAndPluggedIn) {
  Running rig;
  ASSERT_EQ(rig.read(100), ReadOutcome::kSamples);
  const std::size_t before = rig.received[kImu].rows.size();
  rig.bus.unplug();
  EXPECT_EQ(rig.read(10'000), ReadOutcome::kDisconnected);
  EXPECT_NE(rig.device->disconnection().find("unplugged"), std::string::npos);
  drivers::SampleBlock block = rig.device->make_block(10);
  EXPECT_EQ(*rig.device->read(10ms, block), ReadOutcome::kDisconnected) << "it is still away";
  rig.bus.plug();
  ASSERT_EQ(rig.read(before + 400), ReadOutcome::kSamples);
  for (const Stream stream : kStreams) {
    const Received& got = rig.received[stream];
    EXPECT_LE(expect_in_order(got.rows, rig.taken(stream)), 1U);
    EXPECT_EQ(got.flagged(IMUNOISE_SAMPLE_AFTER_RESTART), 1U);
  }
  EXPECT_TRUE(std::is_sorted(rig.received[kImu].times.begin(), rig.received[kImu].times.end()));
  EXPECT_TRUE(rig.noted("is back"));
}

TEST(Adis16405Faults, ALostByteIsNoticed) {
  Running rig;
  ASSERT_EQ(rig.read(100), ReadOutcome::kSamples);
  rig.bus.lose_byte();
  ASSERT_EQ(rig.read(10'000), ReadOutcome::kDisconnected);
  EXPECT_NE(rig.device->disconnection().find("bytes were lost"), std::string::npos);
  const std::size_t before = rig.received[kImu].rows.size();
  EXPECT_LE(before, 110U) << "what followed the loss was taken for samples";
  ASSERT_EQ(rig.read(before + 100), ReadOutcome::kSamples);
  for (const Stream stream : kStreams) {
    EXPECT_LE(expect_in_order(rig.received[stream].rows, rig.taken(stream)), 1U);
    EXPECT_EQ(rig.received[stream].flagged(IMUNOISE_SAMPLE_AFTER_RESTART), 1U);
  }
}

TEST(Adis16405Faults, PermissionThatComesLateIsWaitedFor) {
  Running rig;
  rig.bus.unplug();
  EXPECT_EQ(rig.read(10'000), ReadOutcome::kDisconnected);
  rig.bus.plug();
  rig.bus.set_forbidden(true);
  drivers::SampleBlock block = rig.device->make_block(10);
  EXPECT_EQ(*rig.device->read(10ms, block), ReadOutcome::kDisconnected);
  EXPECT_NE(rig.device->disconnection().find("permission"), std::string::npos);
  rig.bus.set_forbidden(false);
  EXPECT_EQ(rig.read(10'000), ReadOutcome::kSamples);
}

TEST(Adis16405Faults, AShortHoldUpLosesNothing) {
  Running rig;
  for (std::size_t target = 200; target <= 2000; target += 200) {
    rig.bus.hold_up(100ms);
    ASSERT_EQ(rig.read(target), ReadOutcome::kSamples);
  }
  for (const Stream stream : kStreams) {
    expect_stretch(rig.received[stream].rows, rig.taken(stream));
    EXPECT_EQ(rig.received[stream].flagged(~0U), 0U);
  }
}

TEST(Adis16405Faults, ALongHoldUpIsMarkedAsAGap) {
  Running rig;
  rig.bus.hold_up(1s);
  ASSERT_EQ(rig.read(1000), ReadOutcome::kSamples);
  for (const Stream stream : kStreams) {
    const Received& got = rig.received[stream];
    ASSERT_EQ(expect_in_order(got.rows, rig.taken(stream)), 1U);
    ASSERT_EQ(got.flagged(IMUNOISE_SAMPLE_AFTER_GAP), 1U);
    // It is the sample behind the hole that carries the mark.
    const auto marked = static_cast<std::size_t>(
        std::find(got.flags.begin(), got.flags.end(), IMUNOISE_SAMPLE_AFTER_GAP) -
        got.flags.begin());
    const std::vector<Counts> taken = rig.taken(stream);
    const auto index_of = [&](std::size_t row) {
      return std::find(taken.begin(), taken.end(), got.rows[row]) - taken.begin();
    };
    EXPECT_GT(index_of(marked) - index_of(marked - 1), 600);
  }
}

// Two packets of many bursts, read one after the other: the second shows that the first came late.
TEST(Adis16405Faults, LateDataInPortionsStaysInOrder) {
  Running rig;
  rig.bus.hold_up(40ms, 0);
  ASSERT_EQ(rig.read(400), ReadOutcome::kSamples);
  const Received& got = rig.received[kImu];
  const std::size_t first = expect_stretch(got.rows, rig.taken(kImu));
  for (std::size_t i = 0; i < got.rows.size(); ++i) {
    ASSERT_GE(got.times[i], rig.bus.host_time_ns(rig.sensor.taken()[first + i].time)) << i;
    ASSERT_TRUE(i == 0 || got.times[i] > got.times[i - 1]) << i;
  }
}

// Where nothing waits for data-ready and the bridge had nothing to do for a while, a sample that
// waited unread may be renewed in the middle of the next burst, and all its words still be new.
TEST(Adis16405Faults, APolledSensorThatWaitedGivesNoTornSample) {
  Rig rig(drivers::adis16405::kCp2130Id);
  rig.open();
  ASSERT_EQ(rig.read(100), ReadOutcome::kSamples);
  std::size_t target = 100;
  for (int i = 0; i < 100; ++i) {
    rig.bus.hold_up(200ms, 127);  // all that was asked for, or all but one
    target += 100;
    ASSERT_EQ(rig.read(target), ReadOutcome::kSamples);
  }
  const std::size_t holes = expect_in_order(rig.received[kImu].rows, rig.taken(kImu));
  EXPECT_GE(holes, 100U);
  EXPECT_GE(rig.received[kImu].flagged(IMUNOISE_SAMPLE_AFTER_GAP), holes);
}

// Late transfers, and packets of many bursts: their times stay those of the samples. Their order
// is known, and their distance but for the 3 % of the sensor's clock.
TEST(Adis16405Faults, LateDataKeepsItsTimes) {
  Running rig;
  rig.bus.hold_up(20ms, 0);  // 16 bursts in one packet
  ASSERT_EQ(rig.read(200), ReadOutcome::kSamples);
  rig.bus.hold_up(100ms);  // as many transfers as bursts
  ASSERT_EQ(rig.read(400), ReadOutcome::kSamples);
  const Received& got = rig.received[kImu];
  const std::size_t first = expect_stretch(got.rows, rig.taken(kImu));
  for (std::size_t i = 0; i < got.rows.size(); ++i) {
    const std::int64_t taken = rig.bus.host_time_ns(rig.sensor.taken()[first + i].time);
    ASSERT_GE(got.times[i], taken) << i;
    ASSERT_LE(got.times[i], taken + 2'000'000) << i;
    ASSERT_TRUE(i == 0 || got.times[i] > got.times[i - 1]) << i;
  }
  EXPECT_EQ(got.flagged(~0U), 0U);
}

TEST(Adis16405Faults, AnAlarmMarksSamplesAndIsExplained) {
  Running rig;
  rig.sensor.faults.diagnosis = 0x0010;
  ASSERT_EQ(rig.read(3000), ReadOutcome::kSamples);
  const Received& got = rig.received[kImu];
  expect_stretch(got.rows, rig.taken(kImu));
  EXPECT_GT(got.flagged(IMUNOISE_SAMPLE_SUSPECT), 2800U);
  EXPECT_EQ(got.flagged(IMUNOISE_SAMPLE_AFTER_GAP), 0U);
  ASSERT_EQ(rig.notes.size(), 1U) << "one note, however often it is read";
  EXPECT_EQ(rig.notes[0], "DIAG_STAT 0x0010: overrange");
  EXPECT_TRUE(rig.sensor.violations().empty()) << rig.sensor.violations().front();
  rig.sensor.faults.diagnosis = 0;
  const std::size_t more = got.rows.size() + 2000;
  ASSERT_EQ(rig.read(more), ReadOutcome::kSamples);
  EXPECT_EQ(got.flags.back() & IMUNOISE_SAMPLE_SUSPECT, 0U) << "reading DIAG_STAT clears it";
}

TEST(Adis16405Faults, SaturationIsMarked) {
  Rig rig({.rate = {10.0, 0.0, 0.0}});  // 573 deg/s
  rig.open();
  ASSERT_EQ(rig.read(100), ReadOutcome::kSamples);
  EXPECT_EQ(rig.received[kImu].rows[50][0], 8191);
  EXPECT_EQ(rig.received[kImu].flagged(IMUNOISE_SAMPLE_SATURATED), 100U);
  EXPECT_EQ(rig.received[kMagnetometer].flagged(IMUNOISE_SAMPLE_SATURATED), 0U);
}

TEST(Adis16405Faults, CancelEndsAReadOfASilentSensor) {
  Running rig;
  rig.sensor.faults.stalled = true;
  rig.device->cancel();
  drivers::SampleBlock block = rig.device->make_block(10);
  EXPECT_EQ(*rig.device->read(1h, block), ReadOutcome::kCancelled);
}

}  // namespace
}  // namespace imunoise::testing
