// What names of columns mean, and the pace of time stamps.

#include "recording/import/preflight/pace.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <tuple>

#include "recording/import/preflight/clock.h"
#include "recording/import/table/names.h"
#include "recording/import/table/time_names.h"

namespace imunoise::recording {
namespace {

TEST(Names, PeopleCallThem) {
  for (const char* name : {"t", "T", "time", "Timestamp", "time_ms", "timestamp_ns", "%time",
                           "field.header.stamp", "seconds_elapsed"}) {
    EXPECT_TRUE(is_time_name(name)) << name;
  }
  for (const char* name : {"temperature", "gyro_t", "times", "_s", "t_min", ""}) {
    EXPECT_FALSE(is_time_name(name)) << name;
  }
  EXPECT_EQ(*time_unit("t_us", ""), 1e-6);
  EXPECT_EQ(*time_unit("t", "µs"), 1e-6);
  EXPECT_EQ(*time_unit("t", ""), std::nullopt);
  EXPECT_FALSE(time_unit("t", "fortnights"));
  for (const char* name : {"wx", "gx", "gyr_x", "Gyro X", "angular_velocity.x", "GyroX",
                           "field.angular_velocity.x", "w_RS_S_x"}) {
    EXPECT_EQ(common_name(role_of(name)), "gyro_x") << name;
  }
  for (const char* name : {"az", "acc_z", "accelZ", "linear_acceleration.z", "a_RS_S_z"}) {
    EXPECT_EQ(common_name(role_of(name)), "acc_z") << name;
  }
  EXPECT_EQ(common_name(role_of("imu_temp")), "temperature");
  for (const char* name : {"x", "angular_velocity_covariance_0", "note", "box"}) {
    EXPECT_EQ(common_name(role_of(name)), "") << name;
  }
  EXPECT_TRUE(role_of("delta_v_x").increment);
  EXPECT_TRUE(matches("gyro_*", "wx"));
  EXPECT_FALSE(matches("gyro_*", "ax"));
  EXPECT_TRUE(matches("gyr_*", "wx"));
  EXPECT_TRUE(matches("linear_acceleration.*", "ay"));
  EXPECT_FALSE(matches("gyr_*", "ay"));
  EXPECT_FALSE(matches("imu1_gyr_*", "imu2_gyro_x"));
  EXPECT_TRUE(matches("gyr_x", "gyro_x"));
  EXPECT_TRUE(matches("wx", "imu2_gyro_x"));
  EXPECT_FALSE(matches("gyr_x", "gyro_y"));
  EXPECT_FALSE(matches("imu1_gyr_x", "imu2_gyro_x"));
  EXPECT_EQ(role_of("imu2/gyro_x").sensor, "imu2");
  EXPECT_EQ(role_of("gyro2_x").sensor, "2");
  EXPECT_EQ(common_name(role_of("gyro2_x")), "gyro_x");
  EXPECT_EQ(role_of("angular_velocity.x").sensor, role_of("linear_acceleration.z").sensor);
  for (const char* name : {"gyr_x_radps", "gyro_z_rad_per_sec", "gyro_rad_s_1"}) {
    EXPECT_EQ(role_of(name).unit, "rad/s") << name;
  }
  for (const char* name : {"accX_mss", "acc_y_m_per_s2", "acc_mps2_2"}) {
    EXPECT_EQ(role_of(name).unit, "m/s^2") << name;
  }
  EXPECT_EQ(role_of("imu0_gx_dps").unit, "deg/s");
  EXPECT_EQ(role_of("imu0_gx_dps").sensor, "imu0");
  EXPECT_EQ(common_name(role_of("gyro_x_filt")), "gyro_x");
  EXPECT_EQ(*time_unit("time", "milliseconds since 2026-11-29 00:00:00"), 1e-3);
}

std::vector<double> even(std::size_t count, double step) {
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(static_cast<double>(i) * step);
  return out;
}

Pace pace_in(const std::vector<double>& times) {
  const TimeColumn column{"t", "s", times};
  const auto clock = Clock::read("f", column, std::nullopt);
  return pace_of(clock.value(), [](std::size_t) { return false; });
}

// Halves of 100 and 200 Hz were "133.33 Hz", and 1000 Hz behind 100 Hz full of lost samples.
TEST(Pace, ARecorderSetToAnotherRateIsNoMeanOfBoth) {
  for (const auto& [first, second, later] :
       {std::tuple(0.01, 0.005, 10'000U), std::tuple(0.01, 0.001, 100'000U),
        std::tuple(0.005, 0.01, 2'000U)}) {
    std::vector<double> times = even(10'000, first);
    const double from = times.back();
    for (std::size_t i = 1; i <= later; ++i)
      times.push_back(from + static_cast<double>(i) * second);
    const Pace found = pace_in(times);
    ASSERT_EQ(found.others.size(), 1U) << first << " s, then " << second;
    EXPECT_TRUE(found.leaps.empty()) << first << " s, then " << second;
    const OtherPace& other = found.others.front();
    const bool kept_first = other.begin > 0;
    EXPECT_NEAR(found.period, kept_first ? first : second, 1e-9);
    EXPECT_NEAR(other.period, kept_first ? second : first, 1e-9);
    EXPECT_NEAR(static_cast<double>(kept_first ? other.begin : other.end), 10'000.0, 130.0);
  }
}

// Losses throughout and bursts are no other pace.
TEST(Pace, LossesAndBurstsAreNoOtherPace) {
  std::mt19937 random(7);
  std::bernoulli_distribution lost(0.3);
  std::vector<double> thinned;
  std::vector<double> bursts;
  for (const double at : even(20'000, 0.01)) {
    if (at < 100.0 || !lost(random)) thinned.push_back(at);
    bursts.push_back(at < 100.0 ? at : 0.08 * std::ceil(at / 0.08));
  }
  EXPECT_TRUE(pace_in(thinned).others.empty());
  EXPECT_TRUE(pace_in(bursts).others.empty());
}

// Rounded stamps repeat a pattern (8, 8, 9 ms at 120 Hz): no part of them may stand for all.
TEST(Pace, CoarseStampsShowTheRate) {
  for (const double rate : {30.0, 48.0, 60.0, 75.0, 119.0, 120.0, 208.0, 240.0, 480.0, 952.0}) {
    for (const double grain : {1e-2, 1e-3, 1e-4, 1.0 / 128.0}) {
      if (grain * rate > 1.01) continue;
      for (const std::size_t count : {5000U, 40'000U, 100'000U}) {
        std::vector<double> times;
        for (std::size_t i = 0; i < count; ++i)
          times.push_back(grain * std::round(static_cast<double>(i) / rate / grain));
        const Pace found = pace_in(times);
        EXPECT_NEAR(found.period * rate, 1.0, 2.0 * grain * rate / static_cast<double>(count))
            << rate << " Hz in " << grain << " s, " << count;
        EXPECT_TRUE(found.leaps.empty()) << rate << " Hz in " << grain << " s, " << count;
      }
    }
  }
}

TEST(Pace, OnlyLastingLatenessIsAGap) {
  std::vector<double> times = even(1000, 0.01);
  EXPECT_TRUE(pace_in(times).leaps.empty());
  for (std::size_t i = 400; i < times.size(); ++i) times[i] += 0.03;
  const Pace gap = pace_in(times);
  ASSERT_EQ(gap.leaps.size(), 1U);
  EXPECT_EQ(gap.leaps[0].at, 400U);
  EXPECT_NEAR(gap.leaps[0].seconds, 0.03, 1e-6);
  EXPECT_NEAR(gap.period, 0.01, 1e-9);
  times = even(1000, 0.01);
  times[500] += 0.02;  // one stamp is late, and the next are not
  EXPECT_TRUE(pace_in(times).leaps.empty());
  times = even(1000, 0.01);
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = 0.01 * static_cast<double>(i / 8 * 8);
  EXPECT_TRUE(pace_in(times).leaps.empty());  // bursts of eight
  for (std::size_t i = 400; i < times.size(); ++i) times[i] += 0.05;
  EXPECT_EQ(pace_in(times).leaps.size(), 1U);
  times = even(1000, 0.01);
  for (std::size_t i = 700; i < times.size(); ++i) times[i] -= 3.0;
  const Pace back = pace_in(times);
  ASSERT_EQ(back.leaps.size(), 1U);
  EXPECT_NEAR(back.leaps[0].seconds, -3.0, 1e-6);
}

TEST(Pace, JitterIsThatOfTheStamps) {
  std::mt19937_64 random(8);
  std::vector<double> times = even(20'000, 0.01);
  std::normal_distribution<double> normal(0.0, 5e-4);
  for (double& time : times) time += normal(random);
  // The mean square of neighbouring steps of n stamps has a relative variance of 3/n; 4 sigma of a
  // root.
  EXPECT_NEAR(pace_in(times).jitter, 0.05, 0.05 * 2.0 * std::sqrt(3.0 / 20'000));
}

// A buffer that loses every hundredth, or any one in twenty.
TEST(Pace, IsThatOfTheSamplesThatAreThere) {
  std::mt19937 random(9);
  for (const double share : {0.01, 0.05, 0.2}) {
    std::vector<double> times;
    std::size_t lost = 0;
    for (int i = 0; i < 60'000; ++i) {
      const bool gone =
          share == 0.01 ? i % 100 == 50 : std::uniform_real_distribution<>()(random) < share;
      if (!gone) times.push_back(0.005 * i);
      lost += gone ? 1U : 0U;
    }
    const Pace pace = pace_in(times);
    EXPECT_NEAR(pace.period, 0.005, 1e-6) << share;
    EXPECT_GT(pace.leaps.size(), lost * 7 / 10) << share;  // some are lost together
  }
}

// Rows that come late and then all at once: none is lost.
TEST(Pace, AStallIsNoGap) {
  for (const std::size_t rows : {8U, 20U, 60U}) {
    std::vector<double> times = even(20'000, 0.005);
    for (std::size_t i = 0; i < rows; ++i)
      times[9'000 + i] = times[9'000 + rows] - 1e-5 * static_cast<double>(rows - i);
    const Pace pace = pace_in(times);
    EXPECT_TRUE(pace.leaps.empty()) << rows;
    EXPECT_NEAR(pace.period, 0.005, 1e-8) << rows;
  }
}

// Steps of 1 and 2 ms: of a sensor at 952 Hz whose stamps are in ms, or of one at 1 kHz that loses
// samples. The first come in turn.
TEST(Pace, CoarseStampsAreNoLosses) {
  std::vector<double> times;
  for (int i = 0; i < 20'000; ++i) times.push_back(std::round(1e3 * i / 952.0) * 1e-3);
  const Pace coarse = pace_in(times);
  EXPECT_NEAR(1.0 / coarse.period, 952.0, 0.2);
  EXPECT_TRUE(coarse.leaps.empty());
  std::mt19937 random(10);
  times.clear();
  for (int i = 0; i < 20'000; ++i) {
    if (std::uniform_real_distribution<>()(random) > 0.05) times.push_back(i * 1e-3);
  }
  const Pace lossy = pace_in(times);
  EXPECT_NEAR(1.0 / lossy.period, 1000.0, 0.1);
  EXPECT_GT(lossy.leaps.size(), 850U);
}

}  // namespace
}  // namespace imunoise::recording
