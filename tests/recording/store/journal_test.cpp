// Journal segments that were cut off or damaged: the whole blocks are there, once, and it is told
// where they are not.

#include <gtest/gtest.h>

#include <random>

#include "recording/store/format/format_version.h"
#include "recording/store/journal/journal_reader.h"
#include "tests/recording/store/samples.h"

namespace imunoise::recording {
namespace {

constexpr int kFewBlocks = 6;

v1::JournalHeader header() {
  v1::JournalHeader out;
  out.set_version(kFormatVersion);
  out.set_replicate(1);
  out.set_segment(1);
  *out.mutable_device() = test_device();
  return out;
}

// A segment and where its frames end.
struct Bytes {
  std::string all = header_frame(header());
  std::vector<std::size_t> ends = {all.size()};

  void add(std::uint64_t sequence, const Block& block) {
    all += block_frame(sequence, block);
    ends.push_back(all.size());
  }
};

Bytes segment() {
  Bytes out;
  for (int i = 0; i < kFewBlocks; ++i) {
    out.add(static_cast<std::uint64_t>(i) + 1, imu_block(i * 3, 3));
  }
  return out;
}

TEST(JournalSegment, ComesBack) {
  Bytes bytes = segment();
  Block refusing = slow_block(0);
  refusing.rows.refused = {{Refused::kStale, "", 2}, {Refused::kOutOfRange, "temperature", 1}};
  refusing.rows.received += 3;
  bytes.add(7, refusing);
  const auto back = read_segment(bytes.all, 0, nullptr);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_TRUE(back->damage.empty());
  ASSERT_TRUE(back->chunk);
  EXPECT_EQ(back->chunk->device.DebugString(), test_device().DebugString());
  EXPECT_EQ(back->chunk->first_sequence, 1U);
  EXPECT_EQ(back->chunk->last_sequence, 7U);
  EXPECT_EQ(back->chunk->streams[0].channels, imu_block(0, 18).rows.channels);
  EXPECT_EQ(back->chunk->streams[0].host_time, imu_block(0, 18).rows.host_time);
  EXPECT_EQ(back->chunk->streams[1].refused, refusing.rows.refused);
  EXPECT_EQ(back->chunk->streams[1].received, 4U);
}

TEST(JournalSegment, CutAnywhereKeepsTheWholeBlocks) {
  const Bytes bytes = segment();
  for (std::size_t size = bytes.ends[0]; size <= bytes.all.size(); ++size) {
    const auto back = read_segment(std::string_view(bytes.all).substr(0, size), 0, nullptr);
    ASSERT_TRUE(back);
    std::size_t whole = 0;
    while (whole < kFewBlocks && bytes.ends[whole + 1] <= size) ++whole;
    ASSERT_EQ(back->chunk.has_value(), whole > 0);
    if (whole > 0) {
      ASSERT_EQ(row_indices(back->chunk->streams[0]),
                row_indices(imu_block(0, 3 * static_cast<int>(whole)).rows));
    }
    if (size == bytes.ends[whole]) {
      ASSERT_TRUE(back->damage.empty());
    } else {
      ASSERT_EQ(back->damage.size(), 1U);
      ASSERT_TRUE(back->damage[0].at_end);
      ASSERT_EQ(back->damage[0].offset, bytes.ends[whole]);
    }
  }
}

TEST(JournalSegment, AFlippedBitCostsItsOwnBlockOnly) {
  const Bytes bytes = segment();
  std::mt19937_64 random(5);
  for (std::size_t i = bytes.ends[0]; i < bytes.all.size(); ++i) {
    std::string damaged = bytes.all;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << (random() % 8)));
    const auto back = read_segment(damaged, 0, nullptr);
    ASSERT_TRUE(back && back->chunk) << i;
    std::size_t hit = 0;
    while (bytes.ends[hit + 1] <= i) ++hit;
    std::vector<std::int32_t> rest;
    for (std::int32_t row = 0; row < 3 * kFewBlocks; ++row) {
      if (static_cast<std::size_t>(row) / 3 != hit) rest.push_back(row);
    }
    ASSERT_EQ(row_indices(back->chunk->streams[0]), rest) << "byte " << i;
    ASSERT_EQ(back->damage.size(), 1U);
    ASSERT_EQ(back->damage[0].at_end, hit + 1 == kFewBlocks);
    if (hit + 1 < kFewBlocks) {  // the row after the damage says that rows are missing
      ASSERT_EQ(back->chunk->streams[0].flags[3 * hit], std::uint32_t{kLostBefore});
    }
    if (hit > 0 && hit + 1 < kFewBlocks) {
      ASSERT_EQ(back->lost_blocks, 1U);
    }
  }
}

TEST(JournalSegment, BlocksWrittenTwiceAreReadOnce) {
  Bytes bytes = segment();
  bytes.add(5, imu_block(12, 3));
  bytes.add(6, imu_block(15, 3));
  bytes.add(7, imu_block(18, 3));
  const auto back = read_segment(bytes.all, 2, nullptr);
  ASSERT_TRUE(back && back->chunk);
  EXPECT_EQ(back->chunk->first_sequence, 3U);
  EXPECT_EQ(row_indices(back->chunk->streams[0]), row_indices(imu_block(6, 15).rows));
  EXPECT_EQ(back->chunk->streams[0].flags, std::vector<std::uint32_t>(15, 0));
}

TEST(JournalSegment, WithoutItsHeaderANeighboursServes) {
  const Bytes bytes = segment();
  std::string damaged = bytes.all;
  damaged[30] = static_cast<char>(damaged[30] ^ 1);
  const auto alone = read_segment(damaged, 0, nullptr);
  ASSERT_TRUE(alone);
  EXPECT_FALSE(alone->chunk);
  EXPECT_EQ(alone->unusable, static_cast<std::uint64_t>(kFewBlocks));
  const v1::JournalHeader neighbour = header();
  const auto helped = read_segment(damaged, 0, &neighbour);
  ASSERT_TRUE(helped && helped->chunk);
  EXPECT_EQ(row_indices(helped->chunk->streams[0]), row_indices(imu_block(0, 18).rows));
}

TEST(JournalSegment, AnotherVersionIsLeftAlone) {
  v1::JournalHeader later = header();
  later.set_version(2);
  const auto back = read_segment(header_frame(later), 0, nullptr);
  ASSERT_FALSE(back);
  EXPECT_NE(back.error().message.find("version 2"), std::string::npos) << back.error().message;
}

TEST(Description, RefusesWhatCannotBe) {
  const auto message = [](auto change) {
    v1::RecordedDevice device = test_device();
    change(device);
    const auto checked = check_device(device);
    return checked ? std::string("accepted") : checked.error().message;
  };
  const auto has = [](const std::string& text, const char* part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  has(message([](auto& d) { d.set_name("../etc"); }), "'../etc'");
  has(message([](auto& d) { d.clear_streams(); }), "no stream");
  has(message([](auto& d) { d.mutable_streams(1)->set_name("imu"); }), "two streams");
  has(message([](auto& d) { d.mutable_streams(0)->set_rate_hz(0.0); }), "rate_hz 0");
  has(message([](auto& d) { d.mutable_streams(0)->mutable_channels(0)->set_dtype("<u2"); }), "<u2");
  has(message([](auto& d) { d.mutable_streams(0)->mutable_channels(0)->set_name("flags"); }),
      "flags");
  has(message([](auto& d) { d.mutable_streams(0)->mutable_channels(0)->set_scale_factor(0); }),
      "factor");
  has(message([](auto&) {}), "accepted");
}

TEST(Description, RefusesBlocksThatDoNotAddUp) {
  const auto message = [](auto change) {
    Block block = imu_block(0, 4);
    change(block);
    const auto checked = check_block(test_device(), block);
    return checked ? std::string("accepted") : checked.error().message;
  };
  const auto has = [](const std::string& text, const char* part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  has(message([](Block& b) { b.stream = 2; }), "stream 2");
  has(message([](Block& b) { b.rows.received = 5; }),
      "5 rows received are not 4 stored and 0 refused");
  has(message([](Block& b) { b.rows.counter.pop_back(); }), "differ in length");
  has(message([](Block& b) { b.rows.channels.pop_back(); }), "1 columns");
  has(message([](Block& b) { b.rows.channels[0] = std::vector<float>(4); }), "gyro_x");
  has(message([](Block& b) { b.rows.refused = {{Refused::kStale, "nobody", 0}}; }), "'nobody'");
  has(message([](Block&) {}), "accepted");
}

}  // namespace
}  // namespace imunoise::recording
