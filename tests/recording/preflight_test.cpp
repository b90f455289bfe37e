// One judge for all formats: time, units, faults, stretches.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <random>

#include "tests/recording/files.h"

namespace imunoise::recording {
namespace {

class Odd : public FileTest {
 protected:
  using Cell = std::function<std::string(int)>;

  // 200 rows at 100 Hz; what replaces a row, and the stamps.
  Result<std::vector<Replicate>> odd(const std::string& head, const Cell& row,
                                     const ImportOptions& options = {}) const {
    std::string text = head + "\n";
    for (int i = 0; i < 200; ++i) text += row(i) + "\n";
    return import_one(write("odd.csv", text), options);
  }
  double rate(const std::string& head, const Cell& stamp) const {
    const auto got = odd(head + ",x", [&](int i) { return stamp(i) + ",1"; });
    EXPECT_TRUE(got) << got.error().message;
    return got ? got->front().rate.value : 0.0;
  }
  static std::string findings(const Replicate& one) {
    std::string out;
    for (const Finding& finding : one.preflight->findings) out += finding.text + "\n";
    for (const std::string& said : one.preflight->recognised) out += said + "\n";
    return out;
  }
};

TEST_F(Odd, TimesOfEveryKindGiveTheRate) {
  EXPECT_EQ(rate("t", [](int i) { return fmt::format("{:.2f}", 0.01 * i); }), 100.0);
  EXPECT_EQ(rate("t", [](int i) { return fmt::format("{}", 10 * i); }), 100.0);
  EXPECT_EQ(rate("t", [](int i) { return fmt::format("{}", 10'000 * i); }), 100.0);
  EXPECT_EQ(rate("t", [](int i) { return fmt::format("{}", 10'000'000LL * i); }), 100.0);
  EXPECT_EQ(rate("t", [](int i) { return fmt::format("{:.3f}", 1403636580.5 + 0.01 * i); }), 100.0);
  EXPECT_EQ(rate("t", [](int i) { return fmt::format("{}", 1403636580838LL + 10 * i); }), 100.0);
  EXPECT_EQ(
      rate("t", [](int i) { return fmt::format("{}", 1403636580838555648LL + 10000000LL * i); }),
      100.0);
  EXPECT_EQ(rate("t",
                 [](int i) {
                   return fmt::format("2026-11-24T11:59:{:02}.{:02}Z", 58 + i / 100, i % 100);
                 }),
            100.0);
}

TEST_F(Odd, GapsAndMissingValuesCutTheRecording) {
  const auto got = odd("t [s],x [deg/s]", [](int i) {
    return fmt::format("{:.2f},{}", 0.01 * i + (i >= 100 ? 0.5 : 0.0), i == 50 ? "nan" : "1.5");
  });
  ASSERT_TRUE(got) << got.error().message;
  ASSERT_EQ(got->size(), 3U);
  EXPECT_EQ((*got)[0].channels[0].count, 50U);
  EXPECT_EQ((*got)[1].channels[0].count, 49U);
  EXPECT_EQ((*got)[2].channels[0].count, 100U);
  EXPECT_EQ((*got)[0].rate.value, 100.0);
  expect_parts(findings(got->front()), {"gap of 0.5 s at 0.99 s (row 102)", "50 samples",
                                        "misses 1 value, the first at 0.5 s (row 52)"});
  ImportOptions strict;
  strict.strict = true;
  expect_parts(error_of(path("odd.csv"), strict), {"--strict", "gap of 0.5 s", "misses 1 value"});
}

TEST_F(Odd, RowsThatRepeatOrCannotBeReadAreLeftOut) {
  const auto got = odd("t [s],x,frame", [](int i) {
    if (i == 70) return std::string("0.70,abc,imu");
    return fmt::format("{:.2f},{},imu", 0.01 * (i >= 120 ? i - 1 : i), i >= 120 ? i - 1 : i);
  });
  ASSERT_TRUE(got) << got.error().message;
  ASSERT_EQ(got->size(), 2U);
  EXPECT_EQ(got->front().channels.size(), 1U);
  EXPECT_EQ((*got)[0].channels[0].count, 70U);
  EXPECT_EQ((*got)[1].channels[0].count, 128U);
  expect_parts(findings(got->front()), {"1 rows repeat the row before", "row 122", "'abc'",
                                        "row 72", "column frame holds text"});
}

TEST_F(Odd, TimesThatAreWanted) {
  ImportOptions options;
  options.from = 0.1;
  options.until = 1.5;
  options.exclude = {{0.5, 0.6}};
  const auto got = odd(
      "t [s],x", [](int i) { return fmt::format("{:.2f},1", 0.01 * i); }, options);
  ASSERT_TRUE(got) << got.error().message;
  ASSERT_EQ(got->size(), 2U);
  EXPECT_EQ((*got)[0].channels[0].begin, 10U);
  EXPECT_EQ((*got)[0].channels[0].count, 40U);
  EXPECT_EQ((*got)[1].channels[0].begin, 60U);
  EXPECT_EQ((*got)[1].channels[0].count, 90U);
}

TEST_F(Odd, TimesThatNoSampleHasAreTold) {
  ImportOptions options;
  options.exclude = {{-10.0, -5.0}, {0.5, 0.6}, {99.0, 100.0}};
  const auto got = odd(
      "t [s],x", [](int i) { return fmt::format("{:.2f},1", 0.01 * i); }, options);
  ASSERT_TRUE(got) << got.error().message;
  const std::string told = findings(got->front());
  expect_parts(told, {"--exclude -10..-5 excludes no sample: the file covers 0 to",
                      "--exclude 99..100 excludes no sample"});
  EXPECT_EQ(told.find("0.5..0.6"), std::string::npos);
}

TEST_F(Odd, UnitsOfEachKind) {
  const auto row = [](int i) { return fmt::format("{:.2f},0.1,0.1,0.2,9.79", 0.01 * i); };
  ImportOptions options;
  options.units = {{"gyro_*", *parse_unit("deg/s")}};
  const auto got = odd("t,wx,ax,ay,az", row, options);
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_EQ(got->front().channels[0].unit.symbol, "deg/s");
  EXPECT_EQ(got->front().channels[3].unit.symbol, "m/s^2");
  expect_parts(findings(got->front()), {"angular rates wx: deg/s (--unit)",
                                        "accelerations ax, ay, az: m/s^2", "norm is 9.79"});
  options.units = {{"*", *parse_unit("deg/s")}};
  const auto mixed = odd("t,wx,ax,ay,az", row, options);
  ASSERT_FALSE(mixed);
  expect_parts(mixed.error().message, {"--unit deg/s", "channel ax", "'gyro_*=deg/s,acc_*=g'"});
  options.units = {{"gyro_*", *parse_unit("deg/s")}, {"rate_*", *parse_unit("deg/s")}};
  const auto mistyped = odd("t,wx,ax,ay,az", row, options);
  ASSERT_FALSE(mistyped);
  expect_parts(mistyped.error().message, {"--unit rate_*=deg/s", "no channel", "wx, ax, ay, az"});
  const auto wrong = odd("t,wx [deg/s],ax [g],ay [g],az [g]", row);
  ASSERT_TRUE(wrong) << wrong.error().message;
  expect_parts(findings(wrong->front()), {"stated in g", "not 9.81"});
}

// White noise of six axes at rest, with gravity, at 100 Hz; `also` is added to row i of axis a.
using Also = std::function<double(int row, int axis)>;

class Rest : public Odd {
 protected:
  static constexpr int kRestRows = 20'000;

  static std::vector<std::array<double, 6>> rest(unsigned seed, const Also& also = {}) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<std::array<double, 6>> out(kRestRows);
    for (int i = 0; i < kRestRows; ++i) {
      for (int a = 0; a < 6; ++a) {
        double& to = out[static_cast<std::size_t>(i)][static_cast<std::size_t>(a)];
        to = (a < 3 ? 0.002 : 0.02) * normal(random) + (a == 5 ? 9.81 : 0.0);
        if (also) to += also(i, a);
      }
    }
    return out;
  }
  Result<std::vector<Replicate>> imported(const std::vector<std::array<double, 6>>& rows,
                                          const std::string& unit = "rad/s",
                                          const ImportOptions& options = {}) const {
    std::string text = fmt::format("t [s],wx [{0}],wy [{0}],wz [{0}],ax,ay,az\n", unit);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      text += fmt::format("{:.2f}", 0.01 * static_cast<double>(i));
      for (const double value : rows[i]) text += fmt::format(",{:.9g}", value);
      text += "\n";
    }
    return import_one(write("rest.csv", text), options);
  }
};

TEST_F(Rest, SoundSamplesRaiseNoDoubt) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto got = imported(rest(seed));
    ASSERT_TRUE(got) << got.error().message;
    EXPECT_EQ(got->size(), 1U) << "seed " << seed;
    EXPECT_TRUE(got->front().preflight->findings.empty()) << findings(got->front());
  }
}

TEST_F(Rest, AKnockOfSeveralAxesIsLeftOut) {
  for (const int at : {15'000, 500}) {  // the second one before the watch knows the noise
    const auto got = imported(rest(6, [&](int row, int axis) {
      return row >= at && row < at + 250 ? (axis < 3 ? 0.05 : 0.5) * std::sin(0.3 * row) : 0.0;
    }));
    ASSERT_TRUE(got) << got.error().message;
    const Finding& found = got->front().preflight->findings.front();
    EXPECT_EQ(found.severity, Severity::kLeftOut);
    expect_parts(found.text, {"disturbed from", "left out"});
    std::size_t used = 0;
    for (const Replicate& one : *got) {
      const std::size_t begin = one.channels[0].begin;
      const std::size_t end = begin + one.channels[0].count;
      used += one.channels[0].count;
      EXPECT_TRUE(end <= static_cast<std::size_t>(at) ||
                  begin >= static_cast<std::size_t>(at) + 250)
          << begin << " to " << end;
    }
    EXPECT_GT(used, kRestRows * 9U / 10U - 600U);
  }
}

TEST_F(Rest, DisturbanceIsUsedWhereItIsAskedFor) {
  ImportOptions options;
  options.use_disturbed = true;
  const auto got = imported(
      rest(6,
           [](int row, int) { return row >= 15'000 && row < 15'250 ? std::sin(0.3 * row) : 0.0; }),
      "rad/s", options);
  ASSERT_TRUE(got) << got.error().message;
  ASSERT_EQ(got->size(), 1U);
  expect_parts(findings(got->front()), {"disturbed from", "usual scatter): used"});
}

// A channel that hangs for most of the time has no usual scatter: its sound part, at the beginning,
// was told as a disturbance of 10¹³ times that.
TEST_F(Rest, WhatComesBeforeAHangIsNoDisturbance) {
  auto rows = rest(8);
  for (std::size_t i = 8'000; i < rows.size(); ++i) rows[i][1] = rows[8'000][1];
  const auto got = imported(rows);
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_EQ(findings(got->front()).find("wy changes from"), std::string::npos)
      << findings(got->front());
}

TEST_F(Rest, AStepOfOneAxisIsToldAndUsed) {
  const auto got =
      imported(rest(7, [](int row, int axis) { return axis == 1 && row > 9'000 ? 0.02 : 0.0; }));
  ASSERT_TRUE(got) << got.error().message;
  ASSERT_EQ(got->size(), 1U);
  expect_parts(findings(got->front()), {"wy changes from 90", "no other channel", "--exclude"});
}

// What the other axes show counts where one is asked for, and only the one comes back.
TEST_F(Rest, OneChannelIsJudgedBesideItsAxes) {
  const auto knock = [](int row, int axis) {
    return row >= 15'000 && row < 15'250 ? (axis < 3 ? 0.05 : 0.5) * std::sin(0.3 * row) : 0.0;
  };
  ImportOptions options;
  options.channels = {"wy"};
  const auto got = imported(rest(6, knock), "rad/s", options);
  ASSERT_TRUE(got) << got.error().message;
  ASSERT_EQ(got->front().channels.size(), 1U);
  EXPECT_EQ(got->front().channels[0].name, "wy");
  expect_parts(findings(got->front()), {"disturbed from", "left out"});
  options.channels = {"acc_z", "gyro_x"};
  const auto two = imported(rest(6), "rad/s", options);
  ASSERT_TRUE(two) << two.error().message;
  ASSERT_EQ(two->front().channels.size(), 2U);
  EXPECT_EQ(two->front().channels[0].name, "az");
  EXPECT_EQ(two->front().channels[0].unit.symbol, "m/s^2");
  EXPECT_EQ(two->front().channels[1].name, "wx");
  EXPECT_TRUE(two->front().preflight->findings.empty()) << findings(two->front());
}

TEST_F(Rest, RepeatedSamplesAreTold) {
  auto rows = rest(8);
  for (std::size_t i = 1; i < rows.size(); i += 2) {
    for (std::size_t a = 3; a < 6; ++a) rows[i][a] = rows[i - 1][a];
  }
  const auto got = imported(rows);
  ASSERT_TRUE(got) << got.error().message;
  expect_parts(findings(got->front()),
               {"50 % of the accelerations repeat", "about 50 Hz", "m/s^2"});
}

TEST_F(Rest, InterpolatedSamplesAreTold) {
  auto rows = rest(9);
  for (std::size_t i = 1; i + 1 < rows.size(); i += 2) {
    for (std::size_t a = 0; a < 3; ++a) rows[i][a] = 0.5 * (rows[i - 1][a] + rows[i + 1][a]);
  }
  const auto got = imported(rows);
  ASSERT_TRUE(got) << got.error().message;
  expect_parts(findings(got->front()), {"50 % of the angular rates lie on straight lines"});
}

TEST_F(Rest, AFilteredStreamIsTold) {
  auto rows = rest(10);
  for (std::size_t i = 1; i < rows.size(); ++i) {  // two poles, half of the power at 9 Hz
    for (std::size_t a = 0; a < 3; ++a) rows[i][a] = 0.6 * rows[i - 1][a] + 0.4 * rows[i][a];
  }
  for (std::size_t i = 1; i < rows.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a) rows[i][a] = 0.6 * rows[i - 1][a] + 0.4 * rows[i][a];
  }
  const auto got = imported(rows);
  ASSERT_TRUE(got) << got.error().message;
  expect_parts(findings(got->front()), {"power of the angular rates falls", "filtered"});
  // A random walk falls everywhere: it is no filter.
  auto walk = rest(11);
  for (std::size_t i = 1; i < walk.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a) walk[i][a] += walk[i - 1][a];
  }
  const auto walked = imported(walk);
  ASSERT_TRUE(walked) << walked.error().message;
  EXPECT_EQ(findings(walked->front()).find("filtered"), std::string::npos);
}

TEST_F(Odd, AllUnknownUnitsAreToldAtOnce) {
  EXPECT_FALSE(
      odd("t [s],x [cubit],y [ell]", [](int i) { return fmt::format("{:.2f},1,2", 0.01 * i); }));
  expect_parts(error_of(path("odd.csv")), {"channel x", "'cubit'", "channel y", "'ell'"});
}

TEST_F(Odd, IncrementsBecomeRates) {
  const auto got = odd("t [s],dtheta_x [rad],dvx,dvy,dvz", [](int i) {
    return fmt::format("{:.2f},{},0,0,{}", 0.01 * i, 0.001 * (i % 7), 0.0981 + 1e-5 * (i % 5));
  });
  ASSERT_TRUE(got) << got.error().message;
  const Channel& rate = got->front().channels[0];
  EXPECT_EQ(rate.unit.symbol, "rad/s");
  EXPECT_NEAR(rate.signal().value(6), 0.6, 1e-12);
  EXPECT_NEAR(got->front().channels[3].signal().value(0), 9.81, 1e-9);
  expect_parts(findings(got->front()), {"increments: dtheta_x, dvx, dvy, dvz, divided by 0.01 s"});
  const auto unnamed = odd("t [s],ax,ay,az", [](int i) {
    return fmt::format("{:.2f},0,0,{}", 0.01 * i, 0.0981 + 1e-5 * (i % 5));
  });
  ASSERT_TRUE(unnamed) << unnamed.error().message;
  EXPECT_NEAR(unnamed->front().channels[2].signal().value(0), 9.81, 1e-9);
  // Not at rest in the unit of the header, and gravity in a hundredth of a second.
  const auto stated = odd("t [s],wx [deg/s],ax [m/s^2],ay [m/s^2],az [m/s^2]", [](int i) {
    return fmt::format("{:.2f},{},0,0,{}", 0.01 * i, 0.001 * (i % 7), 0.0981 + 1e-5 * (i % 5));
  });
  ASSERT_TRUE(stated) << stated.error().message;
  EXPECT_EQ(stated->front().channels[0].unit.symbol, "deg/s");
  EXPECT_NEAR(stated->front().channels[0].signal().value(6), 0.6 * 3.14159265358979 / 180.0, 1e-9);
  EXPECT_NEAR(stated->front().channels[3].signal().value(0), 9.81, 1e-9);
}

// Each sensor by its name: its own unit, its own axes to judge by, never another one's.
TEST_F(Odd, TwoSensorsInOneTable) {
  const std::string head =
      "t [s],imu1_gyro_x,imu1_acc_x,imu1_acc_y,imu1_acc_z,imu2_gyro_x,imu2_acc_x,imu2_acc_y,"
      "imu2_acc_z";
  const auto row = [](int i) {
    return fmt::format("{:.2f},0.1,0,0,9.8,{},0,0,1.0", 0.01 * i, i % 7);
  };
  ImportOptions options;
  options.units = {{"imu1_gyro_*", *parse_unit("rad/s")}, {"imu2_gyro_*", *parse_unit("deg/s")}};
  const auto both = odd(head, row, options);
  ASSERT_TRUE(both) << both.error().message;
  EXPECT_EQ(both->front().channels[0].unit.symbol, "rad/s");
  EXPECT_EQ(both->front().channels[3].unit.symbol, "m/s^2");
  EXPECT_EQ(both->front().channels[4].unit.symbol, "deg/s");
  EXPECT_EQ(both->front().channels[7].unit.symbol, "g");
  options.units.clear();
  options.channels = {"imu2_gyr_x"};
  const auto second = odd(head, row, options);
  ASSERT_TRUE(second) << second.error().message;
  ASSERT_EQ(second->front().channels.size(), 1U);
  EXPECT_EQ(second->front().channels[0].name, "imu2_gyro_x");
  expect_parts(findings(second->front()), {"accelerations imu2_acc_x, imu2_acc_y, imu2_acc_z: g"});
  options.channels = {"gyro_x"};  // a common name stands for both
  EXPECT_EQ(odd(head, row, options).value().front().channels.size(), 2U);
  options.channels = {"imu3_gyro_x"};
  EXPECT_FALSE(odd(head, row, options));
}

// The axes of the slower sensor stand in the same rows.
TEST_F(Odd, OneAxisOfTheSlowerSensor) {
  ImportOptions options;
  options.channels = {"ay"};
  const auto got = odd(
      "t [s],wx [rad/s],ax,ay,az",
      [](int i) {
        const bool both = i % 4 == 0;
        return fmt::format("{:.2f},{},{},{},{}", 0.01 * i, i % 7, both ? "0.1" : "",
                           both ? "0.2" : "", both ? "9.79" : "");
      },
      options);
  ASSERT_TRUE(got) << got.error().message;
  ASSERT_EQ(got->front().channels.size(), 1U);
  EXPECT_EQ(got->front().channels[0].name, "ay");
  EXPECT_EQ(got->front().channels[0].unit.symbol, "m/s^2");
  EXPECT_EQ(got->front().rate.value, 25.0);
}

// Values that another axis misses are none of the channel that is asked for.
TEST_F(Odd, WhatIsReadToJudgeByCutsNothing) {
  ImportOptions options;
  options.channels = {"wx"};
  const auto got = odd(
      "t [s],wx [deg/s],wy [deg/s],ax [cubit]",
      [](int i) { return fmt::format("{:.2f},{},{},0", 0.01 * i, i % 7, i == 50 ? "nan" : "1"); },
      options);
  ASSERT_TRUE(got) << got.error().message;
  ASSERT_EQ(got->size(), 1U);
  EXPECT_EQ(got->front().channels.size(), 1U);
  EXPECT_EQ(got->front().channels[0].count, 200U);
  options.channels = {"ax", "wx"};
  EXPECT_FALSE(odd(
      "t [s],wx [deg/s],ax [cubit]", [](int i) { return fmt::format("{:.2f},1,2", 0.01 * i); },
      options));
  options.channels = {"wz"};
  const auto increments = odd(
      "t [s],wx,wy,wz,ax,ay,az",
      [](int i) {
        return fmt::format("{:.2f},0,0,{},0,0,{}", 0.01 * i, 0.001 * (i % 7),
                           0.0981 + 1e-5 * (i % 5));
      },
      options);
  ASSERT_TRUE(increments) << increments.error().message;
  EXPECT_NEAR(increments->front().channels[0].signal().value(6), 0.6, 1e-12);
}

TEST_F(Odd, SensorsOfTwoRatesInOneTableAreTakenApart) {
  const auto got = odd("t [s],wx [rad/s],ax [m/s^2],temp", [](int i) {
    const std::string acceleration = i % 4 == 0 ? "0.5" : "";
    const std::string warmth = i % 50 == 0 ? "25" : "";
    return fmt::format("{:.2f},{},{},{}", 0.01 * i, 0.1 * (i % 3), acceleration, warmth);
  });
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_EQ(got->size(), 1U);
  EXPECT_DOUBLE_EQ(got->front().rate.value, 100.0);
  ASSERT_EQ(got->front().channels.size(), 1U);
  EXPECT_EQ(got->front().channels[0].count, 200U);
  expect_parts(findings(got->front()),
               {"channel ax (25 Hz) is left out: read it with --channel ax", "temp"});
  ImportOptions slow;
  slow.channels = {"ax"};
  const auto other = import_one(path("odd.csv"), slow);
  ASSERT_TRUE(other) << other.error().message;
  EXPECT_DOUBLE_EQ(other->front().rate.value, 25.0);
  EXPECT_EQ(other->front().channels[0].count, 50U);
}

// Nanoseconds of such a time do not fit into 64 bits.
TEST_F(Odd, AFarTimeOfSensorsThatAreTakenApartIsAGap) {
  const auto got = odd("t [s],wx [rad/s],ax [m/s^2]", [](int i) {
    return fmt::format("{:.2f},{},{}", 0.01 * i + (i >= 150 ? 1e11 : 0.0), 0.1 * (i % 3),
                       i % 4 == 0 ? "0.5" : "");
  });
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_EQ(got->size(), 2U);
  expect_parts(findings(got->front()), {"gap of"});
  EXPECT_EQ(findings(got->front()).find("backwards"), std::string::npos) << findings(got->front());
}

TEST_F(Odd, SensorsInTurnAreJoined) {
  const auto got = odd("t [s],wx [rad/s],ax [m/s^2]", [](int i) {
    return i % 2 == 0 ? fmt::format("{:.3f},{},", 0.005 * i, i)
                      : fmt::format("{:.3f},,{}", 0.005 * i, i);
  });
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_DOUBLE_EQ(got->front().rate.value, 100.0);
  ASSERT_EQ(got->front().channels.size(), 2U);
  EXPECT_EQ(stored_doubles(got->front().channels[0])[10], 20.0);
  EXPECT_EQ(stored_doubles(got->front().channels[1])[10], 21.0);
}

}  // namespace
}  // namespace imunoise::recording
