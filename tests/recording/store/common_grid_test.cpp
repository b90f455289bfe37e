// Streams with clocks of their own on one grid, without a sample that nobody measured.

#include "recording/store/timeline/common_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "recording/store/recorder/recorder.h"
#include "tests/recording/store/samples.h"

namespace imunoise::recording {
namespace {

constexpr double kPeriod = 1e7;  // ns

// `seconds` long, from `after_s` on, and `ppm` faster than 100 Hz.
Timeline line(double after_s, double seconds, double ppm = 0.0, std::size_t begin = 0) {
  return {{begin, static_cast<std::size_t>(std::llround(seconds * 100.0))},
          kStart + std::llround(after_s * 1e9),
          kPeriod * (1.0 - 1e-6 * ppm)};
}

// The rows picked, one after the other.
std::vector<std::size_t> rows_of(const Picked& picked) {
  std::vector<std::size_t> out;
  for (const Part& part : picked.parts) {
    for (std::size_t i = 0; i < part.count; ++i) out.push_back(part.begin + i);
  }
  return out;
}

// How far the middles of blocks of b lie from those of a, in samples of b: the largest.
double farthest(const GridPiece& piece, const std::vector<GridStream>& streams) {
  const auto middles = [&](std::size_t i) {
    const Timeline& own = streams[i].timelines.front();
    const std::vector<std::size_t> rows = rows_of(piece.picked[i]);
    std::vector<double> out;
    for (std::size_t j = 0; j < rows.size(); j += streams[i].averaged) {
      const auto first = static_cast<double>(rows[j] - own.part.begin);
      out.push_back(
          own.time_ns(first + 0.5 * static_cast<double>(streams[i].averaged - 1), kStart));
    }
    return out;
  };
  const auto a = middles(0);
  const auto b = middles(1);
  double out = 0.0;
  for (std::size_t j = 0; j < a.size(); ++j) out = std::max(out, std::abs(b[j] - a[j]));
  return out;
}

TEST(CommonGrid, OneClockNeedsNoChange) {
  const std::vector<GridStream> streams{{{line(0, 60)}, 1}, {{line(0, 60, 0, 500)}, 1}};
  const auto grid = common_grid(streams, 16);
  ASSERT_EQ(grid.size(), 1U);
  EXPECT_EQ(grid[0].count, 6000U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(grid[0].picked[i].dropped, 0U);
    ASSERT_EQ(grid[0].picked[i].parts.size(), 1U);
    EXPECT_EQ(grid[0].picked[i].parts[0].begin, i * 500);
    EXPECT_EQ(grid[0].picked[i].parts[0].count, 6000U);
  }
}

// The later start decides, and the earlier end.
TEST(CommonGrid, IsTheStretchThatAllShare) {
  const std::vector<GridStream> streams{{{line(0, 60)}, 1}, {{line(7.123, 30)}, 1}};
  const auto grid = common_grid(streams, 16);
  ASSERT_EQ(grid.size(), 1U);
  EXPECT_NEAR(static_cast<double>(grid[0].count), 3000.0, 1.0);
  EXPECT_NEAR(static_cast<double>(grid[0].picked[0].parts[0].begin), 712.3, 1.0);
  EXPECT_LE(farthest(grid[0], streams), 0.5 * kPeriod);
  EXPECT_NEAR(seconds_together(streams), 30.0, 1e-6);
}

// Whatever the clocks: each row once and in order, as many as the clocks differ by left out, and
// none farther away than half a sample.
TEST(CommonGrid, KeepsStepWithTheSlowerClock) {
  std::mt19937_64 random(20261122);
  std::uniform_real_distribution<double> ppm(-30'000, 30'000);
  std::uniform_real_distribution<double> later(-3.0, 3.0);
  for (int trial = 0; trial < 50; ++trial) {
    const double a = ppm(random);
    const double b = trial % 2 == 0 ? ppm(random) : a + 1e-3 * ppm(random);
    for (const std::size_t averaged : std::vector<std::size_t>{1, 4, 8}) {
      Timeline fast = line(later(random), 400, b);
      fast.part.count *= averaged;
      fast.period_ns /= static_cast<double>(averaged);
      const std::vector<GridStream> streams{{{line(0, 400, a)}, 1}, {{fast}, averaged}};
      const auto grid = common_grid(streams, 16);
      ASSERT_EQ(grid.size(), 1U);
      EXPECT_GT(grid[0].count, 36'000U);
      for (std::size_t i = 0; i < 2; ++i) {
        const std::vector<std::size_t> rows = rows_of(grid[0].picked[i]);
        ASSERT_EQ(rows.size(), grid[0].count * streams[i].averaged);
        EXPECT_LT(rows.back(), streams[i].timelines[0].part.count);
        for (std::size_t j = 1; j < rows.size(); ++j) ASSERT_GT(rows[j], rows[j - 1]);
        EXPECT_EQ(grid[0].picked[i].dropped, rows.back() - rows.front() + 1 - rows.size());
      }
      const double slow_ns = std::max(streams[0].timelines[0].period_ns,
                                      fast.period_ns * static_cast<double>(averaged));
      EXPECT_NEAR(grid[0].period_ns, slow_ns, 1e-9 * slow_ns);
      const bool first_is_fast = a > b;
      EXPECT_EQ(grid[0].picked[first_is_fast ? 1 : 0].dropped, 0U);
      const double ratio =
          slow_ns / (first_is_fast ? streams[0].timelines[0].period_ns
                                   : fast.period_ns * static_cast<double>(averaged));
      const Picked& thinned = grid[0].picked[first_is_fast ? 0 : 1];
      const auto per_row = static_cast<double>(first_is_fast ? 1 : averaged);
      EXPECT_NEAR(static_cast<double>(thinned.dropped),
                  (ratio - 1.0) * static_cast<double>(grid[0].count) * per_row, 1.01);
      // A clock half a sample off is as good as the next; 1e-6 of a sample makes no difference.
      const double own = first_is_fast ? streams[0].timelines[0].period_ns : fast.period_ns;
      EXPECT_LE(farthest(grid[0], streams), (0.5 + 2e-6) * own);
    }
  }
}

// E W² at half-width m of the window that begins at `first` of these rows, W = Σ h x(rows): for a
// process of this autocovariance, or of minus half its variogram.
template <class Covariance>
double square_of_coefficient(const std::vector<std::size_t>& rows, std::size_t first, std::size_t m,
                             Covariance covariance) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 2 * m; ++i) {
    for (std::size_t j = 0; j < 2 * m; ++j) {
      const auto lag =
          std::abs(static_cast<double>(rows[first + i]) - static_cast<double>(rows[first + j]));
      sum += ((i < m) == (j < m) ? 1.0 : -1.0) * covariance(lag);
    }
  }
  return sum / static_cast<double>(4 * m * m);
}

// Exactly, not by chance: the wavelet variance of white noise does not change at all, that of a
// random walk and of correlated noise by no more than the share of samples that are left out.
TEST(CommonGrid, LeavingSamplesOutAddsNoNoise) {
  for (const double share : {1.0 / 33.0, 1.0 / 200.0}) {
    const std::vector<GridStream> streams{{{line(0, 40)}, 1}, {{line(0, 40, 1e6 * share)}, 1}};
    const auto grid = common_grid(streams, 16);
    ASSERT_EQ(grid.size(), 1U);
    const std::vector<std::size_t> thinned = rows_of(grid[0].picked[1]);
    const std::vector<std::size_t> whole = rows_of(grid[0].picked[0]);
    ASSERT_GT(grid[0].picked[1].dropped, 15U);
    // Every window between one row left out and the next.
    const auto windows = static_cast<std::size_t>(std::lround(1.0 / share)) - 1;
    const auto change = [&](std::size_t m, auto covariance) {
      double sum = 0.0;
      for (std::size_t i = 0; i < windows; ++i)
        sum += square_of_coefficient(thinned, 300 + i, m, covariance);
      return sum / static_cast<double>(windows) / square_of_coefficient(whole, 0, m, covariance) -
             1.0;
    };
    for (const std::size_t m : {std::size_t{1}, std::size_t{4}, std::size_t{16}, std::size_t{64}}) {
      EXPECT_NEAR(change(m, [](double lag) { return lag == 0.0 ? 1.0 : 0.0; }), 0.0, 1e-12);
      // Of the rows that stay: share / (1 - share).
      const double most = share / (1.0 - share) * (1.0 + 1e-9);
      const double walk = change(m, [](double lag) { return -0.5 * lag; });
      EXPECT_GE(walk, 0.9 * most);
      EXPECT_LE(walk, most);
      EXPECT_LE(std::abs(change(m, [](double lag) { return std::pow(0.9, lag); })), most);
    }
  }
}

// Rounding decides what is nearest here; it decides once.
TEST(CommonGrid, HalfASampleApartNothingFlickers) {
  for (std::int64_t later = 24'999'001; later < 24'999'101; ++later) {
    Timeline first = line(0, 360);
    first.period_ns = static_cast<double>(later) / 2.5;
    Timeline second = first;
    second.first_ns += later;
    for (const auto& two : {std::pair(first, second), std::pair(second, first)}) {
      const std::vector<GridStream> streams{{{two.first}, 1}, {{two.second}, 1}};
      const auto grid = common_grid(streams, 16);
      ASSERT_EQ(grid.size(), 1U);
      EXPECT_EQ(grid[0].picked[0].dropped + grid[0].picked[1].dropped, 0U);
    }
  }
}

TEST(CommonGrid, IsShortenedAtItsEnd) {
  const std::vector<GridStream> streams{{{line(0, 100)}, 1}, {{line(0, 400, 500)}, 4}};
  const std::vector<GridStream> same{{{line(0, 100)}, 1}, {{line(0, 25, 500)}, 1}};
  for (const auto& two : {streams, same}) {
    const auto whole = common_grid(two, 16);
    ASSERT_EQ(whole.size(), 1U);
    for (const std::size_t count : {whole[0].count, whole[0].count / 2, std::size_t{1}}) {
      GridPiece piece = whole[0];
      shorten(piece, count);
      EXPECT_EQ(piece.count, count);
      for (std::size_t i = 0; i < 2; ++i) {
        std::vector<std::size_t> rows = rows_of(whole[0].picked[i]);
        rows.resize(count * two[i].averaged);
        EXPECT_EQ(rows_of(piece.picked[i]), rows);
        EXPECT_EQ(piece.picked[i].dropped, rows.back() - rows.front() + 1 - rows.size());
      }
    }
  }
}

TEST(CommonGrid, AGapOfOneCutsAll) {
  const std::vector<GridStream> streams{{{line(0, 100)}, 1},
                                        {{line(0, 30), line(31, 50, 0, 3000)}, 1}};
  const auto grid = common_grid(streams, 16);
  ASSERT_EQ(grid.size(), 2U);
  EXPECT_EQ(grid[0].count, 3000U);
  EXPECT_EQ(grid[1].count, 5000U);
  EXPECT_EQ(grid[1].picked[0].parts[0].begin, 3100U);
  EXPECT_EQ(grid[1].picked[1].parts[0].begin, 3000U);
}

TEST(CommonGrid, IsEmptyWhereTimesDoNotMeet) {
  const std::vector<GridStream> streams{{{line(0, 100)}, 1}, {{line(100.1, 100)}, 1}};
  EXPECT_TRUE(common_grid(streams, 16).empty());
  EXPECT_EQ(seconds_together(streams), 0.0);
  const std::vector<GridStream> silent{{{line(0, 100)}, 1}, {{}, 1}};
  EXPECT_TRUE(common_grid(silent, 16).empty());
  const std::vector<GridStream> hardly{{{line(0, 100)}, 1}, {{line(99.9, 100)}, 1}};
  EXPECT_TRUE(common_grid(hardly, 16).empty());
}

// Rows come late by chance and never early; a gap makes a line of its own.
TEST(Timelines, AreStraightLinesThroughTheEarliest) {
  Rows rows = imu_block(0, 20'000).rows;
  constexpr double kPpm = 40.0;
  std::mt19937_64 random(7);
  std::exponential_distribution<double> late(1.0 / 2e6);  // of 2 ms
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double at = static_cast<double>(i) * kPeriod * (1.0 - 1e-6 * kPpm);
    rows.host_time[i] = kStart + std::llround(at + late(random));
  }
  for (std::size_t i = 12'000; i < rows.size(); ++i) rows.counter[i] += 5;
  const auto found = timelines(test_device().streams(0), rows);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].part.count, 12'000U);
  EXPECT_EQ(found[1].part.begin, 12'000U);
  for (const Timeline& one : found) {
    // Earliest of 100 delays of 2 ms: 20 ± 20 µs; over 80 s and more, windows of 1 s: 20 µs / (80 s
    // · √(80/12)) = 0.1 ppm. Five of these.
    EXPECT_NEAR(one.period_ns, kPeriod * (1.0 - 1e-6 * kPpm), 0.5e-6 * kPeriod);
    const double first = static_cast<double>(one.part.begin) * kPeriod * (1.0 - 1e-6 * kPpm);
    EXPECT_NEAR(static_cast<double>(one.first_ns - kStart), first + 20e3, 40e3);
  }
  rows = imu_block(0, 900).rows;
  EXPECT_TRUE(timelines(test_device().streams(0), rows).empty()) << "9 s say nothing";
}

}  // namespace
}  // namespace imunoise::recording
