// A time column gives the rate, and never lets a gap pass.

#include "recording/import/table/time_column.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/recording/files.h"

namespace imunoise::recording {
namespace {

Result<EvenTimes> read_times(const std::vector<double>& times,
                             std::optional<double> seconds = 1.0) {
  return even_times(times, {"f.csv: column t", seconds,
                            [](std::size_t i) { return "row " + std::to_string(i + 1); }});
}

Result<Hertz> rate_of(const std::vector<double>& times, std::optional<double> seconds = 1.0) {
  return read_times(times, seconds).map([](const EvenTimes& even) { return even.rate; });
}

std::string message_of(const std::vector<double>& times) {
  const auto rate = rate_of(times);
  return rate ? "no error" : rate.error().message;
}

std::vector<double> regular(std::size_t count, double step, double start = 0.0) {
  std::vector<double> times;
  for (std::size_t i = 0; i < count; ++i) times.push_back(start + static_cast<double>(i) * step);
  return times;
}

TEST(TimeColumn, NamesPeopleUse) {
  for (const char* name : {"t", "T", "time", "Timestamp", "time_ms", "timestamp_ns"}) {
    EXPECT_TRUE(is_time_name(name)) << name;
  }
  for (const char* name : {"temperature", "gyro_t", "times", "_s", "t_min", ""}) {
    EXPECT_FALSE(is_time_name(name)) << name;
  }
  EXPECT_EQ(*time_unit("t_us", ""), 1e-6);
  EXPECT_EQ(*time_unit("t", "ms"), 1e-3);
  EXPECT_EQ(*time_unit("t", "µs"), 1e-6);
  EXPECT_EQ(*time_unit("t", ""), std::nullopt);
  EXPECT_FALSE(time_unit("t", "fortnights"));
}

TEST(TimeColumn, RateIsTheShortestNumberThatTheStampsAllow) {
  EXPECT_EQ(rate_of(regular(1000, 0.01))->value, 100.0);
  EXPECT_EQ(rate_of(regular(1000, 1.0 / 819.2))->value, 819.2);
  EXPECT_EQ(rate_of(regular(1000, 5e6, 1.4e18), 1e-9)->value, 200.0);
  std::vector<double> rounded;  // 128 Hz, stamped in whole milliseconds
  for (int i = 0; i < 5000; ++i) rounded.push_back(std::floor(i * 7.8125));
  EXPECT_EQ(rate_of(rounded, 1e-3)->value, 128.0);
  std::mt19937_64 random(7);
  std::vector<double> jittered = regular(20000, 0.01);
  for (double& time : jittered) time += 1e-3 * (static_cast<double>(random() % 1000) / 1000.0);
  EXPECT_EQ(rate_of(jittered)->value, 100.0);
  // A clock that is really 30 ppm off stays so.
  EXPECT_NEAR(rate_of(regular(100000, 0.01 * (1 - 30e-6)))->value, 100.003, 1e-6);
}

TEST(TimeColumn, JitterIsThatOfTheStamps) {
  EXPECT_LT(read_times(regular(1000, 0.01))->jitter, 1e-9);
  std::mt19937_64 random(8);
  std::vector<double> jittered = regular(20'000, 0.01);
  std::normal_distribution<double> normal(0.0, 5e-4);
  for (double& time : jittered) time += normal(random);
  // The mean square of neighbouring steps of n stamps has a relative variance of 3/n; 4 sigma of a
  // root.
  EXPECT_NEAR(read_times(jittered)->jitter, 0.05, 0.05 * 2.0 * std::sqrt(3.0 / 20'000));
}

TEST(TimeColumn, GapsDuplicatesAndReturnsAreNamed) {
  std::vector<double> times = regular(100, 0.01);
  for (std::size_t i = 40; i < times.size(); ++i) times[i] += 0.03;
  expect_parts(message_of(times), {"f.csv: column t: row 41", "gap", "3 samples", "split"});
  times = regular(100, 0.01);
  for (std::size_t i = 99; i < times.size(); ++i) times[i] += 0.01;  // one lost sample, at the end
  expect_parts(message_of(times), {"row 100", "gap", "about 1 samples"});
  times = regular(100, 0.01);
  times[50] = times[49];
  expect_parts(message_of(times), {"row 51", "occurs twice", "--rate"});
  times[50] = times[48];
  expect_parts(message_of(times), {"row 51", "backwards", "split"});
  times = regular(100, 0.01);
  times[50] -= 0.006;
  expect_parts(message_of(times), {"row 51", "uneven"});
  expect_parts(message_of({1.0}), {"one time"});
}

TEST(TimeColumn, StepsWithoutAUnitThatCannotBeSecondsAreRefused) {
  const auto rate = rate_of(regular(100, 10.0), std::nullopt);
  ASSERT_FALSE(rate);
  expect_parts(rate.error().message, {"no unit", "steps by 10", "time [ms]", "--rate"});
  EXPECT_EQ(rate_of(regular(100, 1.0), std::nullopt)->value, 1.0);
}

using TimeInFile = FileTest;

TEST_F(TimeInFile, TheRowIsTheLineOfTheFile) {
  std::string text = "# a comment\n\nt,x\n";
  for (int i = 0; i < 30; ++i) {
    if (i == 10) text += "# another\n\n";
    text += std::to_string(i < 20 ? i * 0.5 : i * 0.5 + 1) + ",1\n";
  }
  // 3 lines before the rows, 2 between them: sample 20 stands in line 26.
  expect_parts(error_of(write("a.csv", text)), {"a.csv: column t: row 26", "gap", "2 samples"});
}

}  // namespace
}  // namespace imunoise::recording
