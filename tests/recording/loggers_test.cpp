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

// Two sensors take turns; each is read by itself, at its own rate.
TEST_F(Loggers, AColumnThatSaysWhichSensorARowIsOf) {
  for (const char* const name : {"imu_id", "I", "instance"}) {
    const auto got = table(fmt::format("t [s],{},gyro_x [rad/s]", name), [&](int i) {
      return fmt::format("{:.4f},{},{:.6e}", 0.005 * i, i % 2, noise(i, 0) + 5.0 * (i % 2));
    });
    ASSERT_TRUE(got) << got.error().message;
    EXPECT_NEAR(got->front().rate.value, 100.0, 1e-6);
    EXPECT_EQ(channels_of(got->front()), "imu0_gyro_x imu1_gyro_x ");
    EXPECT_EQ(got->front().channels[1].count, static_cast<std::size_t>(kLoggedRows / 2));
    EXPECT_NEAR(got->front().channels[1].signal().value(7), noise(15, 0) + 5.0, 1e-6);
    expect_parts(said_of(*got), {"column", "numbers 2 sensors"});
  }
  // One sensor that is named in each row is no table of several.
  const auto one = table("t [s],imu_id,gyro_x [rad/s]", [&](int i) {
    return fmt::format("{:.4f},3,{:.6e}", 0.01 * i, noise(i, 0));
  });
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_EQ(channels_of(one->front()), "imu_id gyro_x ");
  EXPECT_FALSE(table("t [s],sensor,x,y,z", [&](int i) {
    return fmt::format("{:.4f},{},{}", 0.005 * i, i % 2 == 0 ? "gyro" : "acc", three(i));
  }));
  expect_parts(error_of(path("table.csv")), {"names the sensor of each row (acc, gyro)"});
}

// Late stamps lose nothing, and neither do early ones.
TEST_F(Loggers, EarlyStampsAreNoGaps) {
  for (const double early : {0.005, 0.003}) {
    const auto got = table("t [s],gyro_x [rad/s]", [&](int i) {
      return fmt::format("{:.4f},{:.6e}", 0.005 * i - (i % 50 == 30 ? early : 0.0), noise(i, 0));
    });
    ASSERT_TRUE(got) << got.error().message;
    EXPECT_EQ(got->size(), 1U) << said_of(*got);
    EXPECT_NEAR(got->front().rate.value, 200.0, 1e-6);
  }
  // A sample that is lost beside a late stamp still is.
  const auto lost = table("t [s],gyro_x [rad/s]", [&](int i) {
    const int at = i < 2000 ? i : i + 1;
    return fmt::format("{:.4f},{:.6e}", 0.005 * at + (i == 1998 ? 0.0045 : 0.0), noise(i, 0));
  });
  ASSERT_TRUE(lost) << lost.error().message;
  EXPECT_EQ(lost->size(), 2U);
}

TEST_F(Loggers, TimesWhoseUnitIsAGuessSaySo) {
  const auto steps = [&](const char* name) {
    return table(fmt::format("{},gyro_x [rad/s]", name),
                 [&](int i) { return fmt::format("{},{:.6e}", 123456 + i, noise(i, 0)); });
  };
  const auto guessed = steps("time");
  ASSERT_TRUE(guessed);
  expect_parts(said_of(*guessed),
               {"is a guess: in seconds, the rate is 1 Hz", "in milliseconds, it is 1000 Hz"});
  const auto stated = steps("time_ms");
  ASSERT_TRUE(stated);
  EXPECT_EQ(said_of(*stated).find("guess"), std::string::npos);
  // The name of a counter of 100 us, which another device of Xsens counts in microseconds.
  const auto dot = table("SampleTimeFine,Gyr_X", [&](int i) {
    return fmt::format("{},{:.6e}", 500000 + 5000 * i, noise(i, 0));
  });
  ASSERT_TRUE(dot);
  EXPECT_NEAR(dot->front().rate.value, 200.0, 1e-6);
}

TEST_F(Loggers, DatesAndHoursInColumnsOfOtherNames) {
  for (const char* const name : {"", "Recorded", "hours"}) {
    const bool hours = std::string_view(name) == "hours";
    const auto got = table(fmt::format("{},gyro_x [rad/s]", name), [&](int i) {
      const std::string date = fmt::format("2026-11-29 12:00:{:06.3f}", 0.01 * i);
      return fmt::format("{},{:.6e}", hours ? fmt::format("{:.10f}", 0.01 * i / 3600.0) : date,
                         noise(i, 0));
    });
    ASSERT_TRUE(got) << got.error().message;
    EXPECT_NEAR(got->front().rate.value, 100.0, 1e-2) << name;
    EXPECT_EQ(channels_of(got->front()), "gyro_x ");
  }
  // What is stated to be a temperature is no time, however steadily it rises.
  EXPECT_FALSE(table("temp [degC],gyro_x [rad/s]", [&](int i) {
    return fmt::format("{:.6f},{:.6e}", 25.0 + 1e-5 * i, noise(i, 0));
  }));
  expect_parts(error_of(path("table.csv")), {"no time column"});
}

TEST_F(Loggers, LinesAboutTheDeviceOfAnyNumberAndShape) {
  const auto row = [&](int i) { return fmt::format("{:.2f},{}", 0.01 * i, three(i)); };
  const std::string names = "t [s],gyro_x [rad/s],gyro_y [rad/s],gyro_z [rad/s]";
  for (const std::string head :
       {"Device,A1\nFirmware,v2\nMode,x\nSite,y\n", "Device: A1\nRate: 100 Hz\nA: b\nC: d\nE: f\n",
        "Device,A1,,\nRate,100,,\nMode,x,,\n", "one line\ntwo line\nthree line\nfour line\n"}) {
    const auto got = table(head + names, row);
    ASSERT_TRUE(got) << head << got.error().message;
    EXPECT_EQ(channels_of(got->front()), "gyro_x gyro_y gyro_z ") << head;
    EXPECT_EQ(got->front().channels[0].count, static_cast<std::size_t>(kLoggedRows)) << head;
  }
  // A row of kinds between names and units, and a unit that is none here.
  const auto kinds = table(
      "Time,Gyro_X,Gyro_Y,Battery\nCAL,CAL,CAL,CAL\nms,deg/s,deg/s,%",
      [&](int i) { return fmt::format("{},{:.6e},{:.6e},98", 10 * i, noise(i, 0), noise(i, 1)); });
  ASSERT_TRUE(kinds) << kinds.error().message;
  EXPECT_EQ(channels_of(kinds->front()), "Gyro_X Gyro_Y ");
  EXPECT_EQ(kinds->front().channels[0].unit.symbol, "deg/s");
}

// As an Arduino prints for its plotter, with blanks, tabs or commas.
TEST_F(Loggers, LabelsBeforeEachNumberAreNames) {
  for (const char* const form : {"t_ms:{},gyro_x_dps:{:.6e}", "t_ms: {}\tgyro_x_dps: {:.6e}",
                                 "t_ms={} ; gyro_x_dps={:.6e}"}) {
    std::string text = "_x_dps:0.1\n";  // the log begins within a line
    for (int i = 0; i < kLoggedRows; ++i)
      text += fmt::format(fmt::runtime(form), 10 * i, noise(i, 0)) + "\n";
    const auto got = import_one(write("serial.txt", text));
    ASSERT_TRUE(got) << form << got.error().message;
    EXPECT_EQ(channels_of(got->front()), "gyro_x_dps ") << form;
    EXPECT_EQ(got->front().channels[0].count, static_cast<std::size_t>(kLoggedRows));
    EXPECT_EQ(got->front().channels[0].unit.symbol, "deg/s");
    EXPECT_NEAR(got->front().rate.value, 100.0, 1e-9);
  }
}

TEST_F(Loggers, ASecondTableInAFileIsNoPartOfTheFirst) {
  EXPECT_FALSE(table("t [s],acc_x [m/s^2]", [&](int i) {
    return i == 2000 ? std::string("t [s],gyro_x [rad/s]")
                     : fmt::format("{:.2f},{:.6e}", 0.01 * (i % 2000), noise(i, 0));
  }));
  expect_parts(error_of(path("table.csv")), {"row 2002", "a second table begins here"});
}

// What looks like the marks of two sensors, two tables or a clock, and is none.
TEST_F(Loggers, OrdinaryColumnsAndLinesSplitNothing) {
  const auto whole = [&](const std::string& head, const std::function<std::string(int)>& row) {
    const auto got = table(head, row);
    ASSERT_TRUE(got) << head << ": " << got.error().message;
    EXPECT_EQ(got->size(), 1U) << head;
    EXPECT_NEAR(got->front().rate.value, 100.0, 1e-6) << head;
    EXPECT_GE(got->front().channels[0].count, static_cast<std::size_t>(kLoggedRows - 1)) << head;
  };
  for (const char* const name : {"id", "signal", "axis", "i", "instance"})
    whole(fmt::format("t [s],gyro_x [rad/s],{}", name),
          [&](int i) { return fmt::format("{:.2f},{:.6e},{}", 0.01 * i, noise(i, 0), i / 500); });
  whole("t [s],gyro_x [rad/s],signal", [&](int i) {
    return fmt::format("{:.2f},{:.6e},{}", 0.01 * i, noise(i, 0), i % 2 == 0 ? "good" : "weak");
  });
  for (const char* const line : {"\xef\xbb\xbft [s],gyro_x [rad/s]", "reset gyro,again", "T,Gyro_X",
                                 "t [s],gyro_x [rad/s],note"})
    whole("t [s],gyro_x [rad/s]", [&](int i) {
      const int at = i < 2000 ? i : i - 1;
      return i == 2000 ? std::string(line) : fmt::format("{:.2f},{:.6e}", 0.01 * at, noise(i, 0));
    });
  whole("counter_ms,rtc,gyro_x [rad/s]", [&](int i) {
    return fmt::format("{},2026-11-29 10:00:{:02d},{:.6e}", 10 * i, i / 100 % 60, noise(i, 0));
  });
  whole("# rate_hz: 100\nsession,gyro_x [rad/s]",
        [&](int i) { return fmt::format("2026-11-29 10:00:00,{:.6e}", noise(i, 0)); });
}

TEST_F(Loggers, EmptyColumnsAreLeftOutWithAStatedRateToo) {
  const auto got = table(
      "gyro_x [rad/s],empty,", [&](int i) { return fmt::format("{:.6e},,", noise(i, 0)); },
      at_rate(100));
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_EQ(channels_of(got->front()), "gyro_x ");
}

}  // namespace
}  // namespace imunoise::recording
