// Tables as loggers, phones and spreadsheets write them, and the defects that loggers make.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "tests/recording/files.h"

namespace imunoise::recording {
namespace {

constexpr int kLoggedRows = 4000;

class Loggers : public FileTest {
 protected:
  // Noise of 1e-3 by row and column, the same at each call.
  double noise(int row, int column) const {
    return noise_[static_cast<std::size_t>(4 * row + column)];
  }
  Result<std::vector<Replicate>> table(const std::string& head,
                                       const std::function<std::string(int)>& row,
                                       const ImportOptions& options = {}) {
    std::string text = head + "\n";
    for (int i = 0; i < kLoggedRows; ++i) text += row(i) + "\n";
    return import_one(write("table.csv", text), options);
  }
  std::string three(int row) const {
    return fmt::format("{:.6e},{:.6e},{:.6e}", noise(row, 0), noise(row, 1), noise(row, 2));
  }

 private:
  std::vector<double> noise_ = [] {
    std::mt19937 random(11);
    std::normal_distribution<double> normal(0.0, 1e-3);
    std::vector<double> out(4 * kLoggedRows);
    for (double& x : out) x = normal(random);
    return out;
  }();
};

std::string said_of(const std::vector<Replicate>& replicates) {
  std::string out;
  for (const std::string& one : replicates.front().preflight->recognised) out += one + "\n";
  for (const Finding& one : replicates.front().preflight->findings) out += one.text + "\n";
  return out;
}

std::string channels_of(const Replicate& one) {
  std::string out;
  for (const Channel& channel : one.channels) out += channel.name + " ";
  return out;
}

TEST_F(Loggers, DaysOfSpreadsheetsAndOfMatlab) {
  for (const double first : {45000.5, 739000.5}) {
    const auto got = table("Time,gyro_x [rad/s]", [&](int i) {
      return fmt::format("{:.10f},{:.6e}", first + 0.01 * i / 86400.0, noise(i, 0));
    });
    ASSERT_TRUE(got) << got.error().message;
    EXPECT_NEAR(got->front().rate.value, 100.0, 0.01) << first;
    expect_parts(said_of(*got), {"days (by their values)"});
  }
  EXPECT_FALSE(table("Time,gyro_x [rad/s]", [&](int i) {
    return fmt::format("{:.10f},{:.6e}", 1.0 + 1e-7 * i, noise(i, 0));
  }));
  expect_parts(error_of(path("table.csv")), {"shorter than those of any inertial sensor"});
}

TEST_F(Loggers, IncrementsThatStateNoUnitHaveNone) {
  const auto got = table(
      "t,DeltaThetaX,DeltaThetaY,DeltaThetaZ,DeltaVelX,DeltaVelY,DeltaVelZ",
      [&](int i) { return fmt::format("{:.2f},{},0.0001,0.0002,0.0980665", 0.01 * i, three(i)); });
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_EQ(got->front().channels[0].unit.quantity, Quantity::kUnknown);
  EXPECT_NEAR(got->front().channels[0].signal().value(5), 100.0 * noise(5, 0), 1e-6);
  EXPECT_EQ(got->front().channels[5].unit.symbol, "m/s^2");
  EXPECT_NEAR(got->front().channels[5].signal().value(5), 9.80665, 1e-9);
}

TEST_F(Loggers, IncrementsOfVelocityInTheUnitOfAcceleration) {
  const auto got = table("t,dv_x [g],dv_y [g],dv_z [g]", [&](int i) {
    return fmt::format("{:.2f},{:.6e},0.0001,0.01", 0.01 * i, noise(i, 0));
  });
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_NEAR(got->front().channels[2].signal().value(5), 9.80665, 1e-9);
}

// Of coarse stamps many rows have one time; these have one time and one value.
TEST_F(Loggers, RowsLoggedTwiceInTurn) {
  for (const int each : {1, 2, 10}) {
    std::string text = "t,gyro_x [rad/s]\n";
    for (int i = 0; i < kLoggedRows; ++i) {
      const std::string row = fmt::format("{:.2f},{:.6e}\n", 0.01 * i, noise(i, 0));
      text += row + (i % each == 0 ? row : "");
    }
    const auto got = import_one(write("twice.csv", text));
    ASSERT_TRUE(got) << got.error().message;
    EXPECT_DOUBLE_EQ(got->front().rate.value, 100.0) << each;
    EXPECT_EQ(got->front().channels[0].count, kLoggedRows) << each;
  }
}

TEST_F(Loggers, ASensorThatHangsIsLeftOut) {
  for (const int frozen : {100, 1500, 3000}) {
    const auto got = table("t,gyro_x [rad/s],gyro_y [rad/s],gyro_z [rad/s]", [&](int i) {
      return fmt::format("{:.2f},{}", 0.01 * i, three(i > 500 && i < 500 + frozen ? 500 : i));
    });
    ASSERT_TRUE(got) << got.error().message;
    EXPECT_EQ(got->front().preflight->used, static_cast<std::size_t>(kLoggedRows - frozen + 1));
    expect_parts(said_of(*got), {"all axes stand still from 5.01 to"});
  }
  // A sensor read five times as fast as it measures repeats by right.
  const auto slow = table("t,gyro_x [rad/s],gyro_y [rad/s]", [&](int i) {
    return fmt::format("{:.2f},{:.6e},{:.6e}", 0.01 * i, noise(i / 5, 0), noise(i / 5, 1));
  });
  ASSERT_TRUE(slow) << slow.error().message;
  EXPECT_EQ(slow->front().preflight->used, static_cast<std::size_t>(kLoggedRows));
}

TEST_F(Loggers, AnAxisThatFailsIsNoSensorOfItsOwn) {
  const auto got = table("t,gyro_x [rad/s],gyro_y [rad/s],gyro_z [rad/s]", [&](int i) {
    const std::string last = i < kLoggedRows / 2 ? fmt::format("{:.6e}", noise(i, 2)) : "nan";
    return fmt::format("{:.2f},{:.6e},{:.6e},{}", 0.01 * i, noise(i, 0), noise(i, 1), last);
  });
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_EQ(channels_of(got->front()), "gyro_x gyro_y gyro_z ");
  expect_parts(said_of(*got), {fmt::format("channel gyro_z misses {} values", kLoggedRows / 2)});
}

TEST_F(Loggers, IndicesAndAxesInBracketsAreNoUnits) {
  const auto px4 = table(
      "timestamp,gyro_rad[0],gyro_rad[1],gyro_rad[2],accelerometer_m_s2[0],accelerometer_m_s2[1],"
      "accelerometer_m_s2[2]",
      [&](int i) { return fmt::format("{},{},0.1,0.2,9.8", 4000 * i, three(i)); });
  ASSERT_TRUE(px4) << px4.error().message;
  EXPECT_EQ(channels_of(px4->front()),
            "gyro_rad_x gyro_rad_y gyro_rad_z accelerometer_m_s2_x accelerometer_m_s2_y "
            "accelerometer_m_s2_z ");
  EXPECT_EQ(px4->front().channels[3].unit.symbol, "m/s^2");
  const auto named = table("t,gyro (x),gyro(y)", [&](int i) {
    return fmt::format("{:.2f},{:.6e},{:.6e}", 0.01 * i, noise(i, 0), noise(i, 1));
  });
  ASSERT_TRUE(named) << named.error().message;
  EXPECT_EQ(channels_of(named->front()), "gyro_x gyro_y ");
}

TEST_F(Loggers, WhatIsNoChannelIsLeftOut) {
  const auto got = table(
      "Time (s),gyro_x [rad/s],ImuGroup.TimeStartup [ns],loggingSample(N),Absolute (rad/s)",
      [&](int i) {
        return fmt::format("{:.2f},{:.6e},{},{},0.001", 0.01 * i, noise(i, 0), 10'000'000L * i, i);
      });
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_EQ(channels_of(got->front()), "gyro_x ");
  expect_parts(said_of(*got),
               {"column ImuGroup.TimeStartup holds times: left out", "is in N, which is no unit",
                "column Absolute is the length of a vector: left out"});
}

TEST_F(Loggers, UnitsBehindTheAxisAndInARowOfTheirOwn) {
  const auto behind = table("time_s,gyro_x_rad_s,gyr_y_dps,acc_z_g,gyro_z_deg_h", [&](int i) {
    return fmt::format("{:.2f},{:.6e},{:.6e},1,{:.6e}", 0.01 * i, noise(i, 0), noise(i, 1),
                       noise(i, 2));
  });
  ASSERT_TRUE(behind) << behind.error().message;
  EXPECT_EQ(behind->front().channels[0].unit.symbol, "rad/s");
  EXPECT_EQ(behind->front().channels[1].unit.symbol, "deg/s");
  EXPECT_EQ(behind->front().channels[2].unit.symbol, "g");
  EXPECT_EQ(behind->front().channels[3].unit.symbol, "deg/h");
  const auto row =
      table("timestamp\tstatus\tgyro_x\tacc_z\n(us)\t(na)\t(rad.s-1)\t(m.s-2)",
            [&](int i) { return fmt::format("{}\t0\t{:.6e}\t9.8", 10'000 * i, noise(i, 0)); });
  ASSERT_TRUE(row) << row.error().message;
  EXPECT_DOUBLE_EQ(row->front().rate.value, 100.0);
  EXPECT_EQ(row->front().channels[2].unit.symbol, "m/s^2");
}

TEST_F(Loggers, HeadersInComments) {
  for (const char* const head :
       {"# t gyro_x[rad/s] gyro_y[rad/s]", "% t gyro_x[rad/s] gyro_y[rad/s]",
        "// Start Time: Unknown\n// Sample rate: 100.0Hz\n// Version: 1.0.0\nt gyro_x[rad/s] "
        "gyro_y[rad/s]"}) {
    const auto got = table(head, [&](int i) {
      return fmt::format("{:.18e} {:.6e} {:.6e}", 0.01 * i, noise(i, 0), noise(i, 1));
    });
    ASSERT_TRUE(got) << head << ": " << got.error().message;
    EXPECT_EQ(channels_of(got->front()), "gyro_x gyro_y ") << head;
    EXPECT_EQ(got->front().channels[0].unit.symbol, "rad/s") << head;
  }
}

TEST_F(Loggers, ABlankBeforeTheZone) {
  const auto got =
      table("loggingTime(txt),motionRotationRateX(rad/s),accelerationX(G)", [&](int i) {
        return fmt::format("2021-06-12 12:00:{:06.3f} +0200,{:.6e},1", 0.01 * i, noise(i, 0));
      });
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_DOUBLE_EQ(got->front().rate.value, 100.0);
  EXPECT_EQ(got->front().channels[1].unit.symbol, "g");
  // A blank without a zone.
  const auto none = table("time,gyro_x [rad/s]", [&](int i) {
    return fmt::format("\"2021-06-12 12:00:{:06.3f} \",{:.6e}", 0.01 * i, noise(i, 0));
  });
  ASSERT_TRUE(none) << none.error().message;
  EXPECT_DOUBLE_EQ(none->front().rate.value, 100.0);
}

}  // namespace
}  // namespace imunoise::recording
