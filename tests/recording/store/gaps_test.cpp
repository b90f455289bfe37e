// Gaps, rates, saturated and stuck channels.

#include "recording/store/timeline/gaps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "recording/store/verify/integrity.h"
#include "tests/recording/store/samples.h"

namespace imunoise::recording {
namespace {

// Takes rows [from, from + count) out.
void lose(Rows& rows, std::size_t from, std::size_t count) {
  const auto cut = [&](auto& values) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(from);
    values.erase(begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  cut(rows.host_time);
  if (!rows.counter.empty()) cut(rows.counter);
  cut(rows.flags);
  for (Numbers& numbers : rows.channels) std::visit(cut, numbers);
  rows.received -= count;
}

Rows imu_rows(int count) { return imu_block(0, count).rows; }

v1::RecordedStream imu() { return test_device().streams(0); }

// The same without a device counter, stamped as transfers of `batch` samples arrive: all at once,
// late by up to 3 ms more; the device's clock is 1.5 % fast.
v1::RecordedStream uncounted() {
  v1::RecordedStream out = imu();
  out.set_counter_modulus(0);
  return out;
}
Rows batched(int count, int batch) {
  std::mt19937_64 random(6);
  Rows out = imu_rows(count);
  out.counter.clear();
  for (int first = 0; first < count; first += batch) {
    const int last = std::min(first + batch, count);
    const std::int64_t late = static_cast<std::int64_t>(random() % 3'000'000);
    for (int i = first; i < last; ++i) {
      out.host_time[static_cast<std::size_t>(i)] = kStart + std::int64_t{last} * 9'850'000 + late;
    }
  }
  return out;
}

std::string described(const std::vector<RowGap>& gaps) {
  std::string out;
  for (const RowGap& gap : gaps) {
    out += std::to_string(gap.before) + ":" + std::to_string(gap.lost) + ":" +
           std::string(word(gap.evidence)) + " ";
  }
  return out;
}

TEST(Gaps, NoneInAWholeStreamThatWraps) {
  EXPECT_EQ(described(find_gaps(imu(), imu_rows(70000))), "");
}

TEST(Gaps, TheCounterCountsWhatIsLost) {
  Rows rows = imu_rows(70000);
  lose(rows, 65530, 10);  // over the wrap
  lose(rows, 100, 1);
  EXPECT_EQ(described(find_gaps(imu(), rows)), "100:1:counter 65529:10:counter ");
}

TEST(Gaps, ADuplicateCutsAndLosesNothing) {
  Rows rows = imu_rows(50);
  rows.counter[20] = 19;
  for (std::size_t i = 21; i < 50; ++i) rows.counter[i] -= 1;
  EXPECT_EQ(described(find_gaps(imu(), rows)), "20:0:duplicate ");
}

TEST(Gaps, TheClockShowsALostWrapOfTheCounter) {
  v1::RecordedStream stream = imu();
  stream.set_counter_modulus(256);
  Rows rows = imu_rows(1000);
  for (auto& counter : rows.counter) counter %= 256;
  lose(rows, 300, 256);
  EXPECT_EQ(described(find_gaps(stream, rows)), "300:256:time ");
}

TEST(Gaps, ACounterThatStartsAgainIsNoLossOfThousands) {
  Rows rows = imu_rows(1000);
  for (std::size_t i = 500; i < 1000; ++i) rows.counter[i] = static_cast<std::int64_t>(i) - 500;
  EXPECT_EQ(described(find_gaps(imu(), rows)), "500:0:counter ");
}

TEST(Gaps, ASampleTimeMayBeTheCounter) {
  v1::RecordedStream stream = imu();
  stream.set_counter_step(100);
  stream.set_counter_modulus(864'000'000);
  Rows rows = imu_rows(100);
  for (std::size_t i = 0; i < 100; ++i) {
    rows.counter[i] = (863'995'000 + 100 * static_cast<std::int64_t>(i)) % 864'000'000;
  }
  lose(rows, 40, 20);
  EXPECT_EQ(described(find_gaps(stream, rows)), "40:20:counter ");
}

TEST(Gaps, StampsOfTransfersAreNoGaps) {
  for (const int batch : {1, 4, 16}) {
    EXPECT_EQ(described(find_gaps(uncounted(), batched(5000, batch))), "") << batch;
  }
}

TEST(Gaps, StampsThatStayLateAreLostSamples) {
  for (const int batch : {1, 4, 16}) {
    Rows rows = batched(5000, batch);
    lose(rows, 3200, static_cast<std::size_t>(2 * batch));
    lose(rows, 1600, static_cast<std::size_t>(batch));
    const std::string lost = std::to_string(batch) + ":time ";
    const std::string twice = std::to_string(2 * batch) + ":time ";
    EXPECT_EQ(described(find_gaps(uncounted(), rows)),
              "1600:" + lost + std::to_string(3200 - batch) + ":" + twice);
  }
}

TEST(Gaps, AFlagCuts) {
  Rows rows = imu_rows(50);
  rows.flags[7] = kLostBefore | 1U;
  rows.flags[9] = 1U;
  const auto gaps = find_gaps(imu(), rows);
  EXPECT_EQ(described(gaps), "7:0:flag ");
  const auto parts = parts_between(gaps, rows.size());
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].count, 7U);
  EXPECT_EQ(parts[1].begin, 7U);
  EXPECT_EQ(parts[1].count, 43U);
}

TEST(Integrity, RateAndJitterOfAStraightClock) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0.0, 50e3);  // ns
  Rows rows = imu_rows(100000);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows.host_time[i] = kStart + static_cast<std::int64_t>(std::llround(
                                     static_cast<double>(i) * 1e9 / 100.3 + normal(random)));
  }
  const v1::StreamIntegrity checked = check_stream(imu(), rows);
  EXPECT_EQ(checked.nominal_rate_hz(), 100.0);
  EXPECT_NEAR(checked.rate_hz(), 100.3, 1e-4);
  EXPECT_NEAR(checked.jitter_s(), 50e-6, 1e-6);  // five standard errors: 50e-6·5/√(2·1e5)
}

v1::ChannelIntegrity checked(const Numbers& numbers) {
  v1::RecordedChannel one = channel("x", "<i2");
  one.set_valid_min(-100);
  one.set_valid_max(100);
  return check_channel(one, numbers);
}

TEST(Integrity, SaturationAndStuckCodes) {
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<std::int16_t> counts(100000);
  for (auto& count : counts) count = static_cast<std::int16_t>(std::lround(normal(random)));
  EXPECT_FALSE(checked(counts).stuck());
  EXPECT_EQ(checked(counts).saturated(), 0U);
  // Equal neighbours: 29 % here; 25 equal in a row come once in 1e13 samples.
  std::fill(counts.begin() + 500, counts.begin() + 530, std::int16_t{2});
  counts[7] = 100;
  counts[8] = -120;
  const v1::ChannelIntegrity out = checked(counts);
  EXPECT_TRUE(out.stuck());
  EXPECT_GE(out.longest_run(), 30U);
  EXPECT_LE(out.longest_run_at(), 500U);
  EXPECT_EQ(out.saturated(), 2U);
  EXPECT_TRUE(checked(std::vector<std::int16_t>(1000, 3)).longest_run() == 1000);
}

TEST(Integrity, CountsAddUp) {
  Rows rows = imu_rows(100);
  rows.refused = {{Refused::kChecksum, "", 3}};
  rows.received = 103;
  rows.counter[50] = 49;
  for (std::size_t i = 60; i < 100; ++i) rows.counter[i] += 5;  // three refused, and two lost
  const v1::StreamIntegrity checked = check_stream(imu(), rows);
  EXPECT_EQ(checked.received(), 103U);
  EXPECT_EQ(checked.stored(), 100U);
  EXPECT_EQ(checked.refused(0).samples(), 3U);
  EXPECT_EQ(checked.duplicates(), 1U);
  EXPECT_EQ(checked.gap_count(), 3U);  // the repeat, the step of two after it, and the five
  EXPECT_EQ(checked.lost(), 3U);
}

}  // namespace
}  // namespace imunoise::recording
