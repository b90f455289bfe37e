// Forty odd files, and what a user gets of each: the table of docs/importing.md.

#include "tests/recording/odd/odd_files.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "tests/recording/files.h"

namespace imunoise::recording::odd {
namespace {

std::string utf16(const std::string& text) {
  std::string out = "\xff\xfe";
  for (const char c : text) out += {c, '\0'};
  return out;
}

std::string with_cr(std::string text) {
  std::replace(text.begin(), text.end(), '\n', '\r');
  return text;
}

// Six axes at rest, with a knock of all of them at 100 s.
std::string knocked() {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  return odd_table(
      "t [s],wx [deg/s],wy [deg/s],wz [deg/s],ax [g],ay [g],az [g]\n",
      [&](int i) {
        std::string out = t(i);
        for (int a = 0; a < 6; ++a) {
          const double knock = i >= 10'000 && i < 10'200 ? std::sin(0.3 * i) : 0.0;
          out += fmt::format(",{:.6f}", 0.01 * normal(random) + knock + (a == 5 ? 1.0 : 0.0));
        }
        return out;
      },
      20'000);
}

// Those with odd layouts, units, sensors and names.
std::vector<OddFile> odd_layouts() {
  OddFiles list;
  std::vector<OddFile>& all = list.all;
  // Layouts.
  list.good("semicolons", "100 Hz", odd_table("t;x\n", [](int i) { return t(i) + ";" + x(i); }),
            "");
  list.good("tabs", "100 Hz", odd_table("t\tx\n", [](int i) { return t(i) + "\t" + x(i); }), "");
  list.good("columns aligned with blanks", "100 Hz",
            odd_table("t x\n", [](int i) { return fmt::format("  {:>8}   {:>10}", t(i), x(i)); }),
            "");
  list.good("line ends of Windows", "100 Hz",
            odd_table("t,x\r\n", [](int i) { return t(i) + "," + x(i) + "\r"; }), "");
  list.good("quoted fields", "100 Hz",
            odd_table("\"t\",\"x\"\n", [](int i) { return "\"" + t(i) + "\",\"" + x(i) + "\""; }),
            "");
  list.good("a byte order mark (UTF-8)", "100 Hz",
            odd_table("\xef\xbb\xbft,x\n", [](int i) { return t(i) + "," + x(i); }), "");
  list.refused("UTF-16 (spreadsheets)", "refused",
               utf16(odd_table("t,x\n", [](int i) { return t(i) + "," + x(i); })), "UTF-16");
  list.good("a header as a comment (EuRoC)", "units from the header",
            odd_table("#timestamp [ns],w_RS_S_x [rad s^-1]\n",
                      [](int i) {
                        return fmt::format("{},{}", 1'403'636'580'838'555'648LL + 10'000'000LL * i,
                                           x(i));
                      }),
            "nanoseconds");
  list.good("`rostopic echo -p`", "rates in rad/s by their names",
            odd_table("%time,field.header.stamp,field.header.frame_id,field.angular_velocity.x\n",
                      [](int i) {
                        const long long now = 1'700'000'000'000'000'000LL + 10'000'000LL * i;
                        return fmt::format("{},{},imu,{}", now, now, x(i));
                      }),
            "holds text")
      .channels = 1;
  list.good("units in a row under the names", "units from that row",
            odd_table("t,gyro_x\ns,deg/s\n", [](int i) { return t(i) + "," + x(i); }), "");
  list.good("an unnamed index column", "left out",
            odd_table(",t,x\n", [](int i) { return fmt::format("{},{},{}", i, t(i), x(i)); }), "");
  list.good("a trailing comma", "100 Hz",
            odd_table("t,x,\n", [](int i) { return t(i) + "," + x(i) + ","; }), "");
  list.good("a column of text", "left out",
            odd_table("t,x,frame\n", [](int i) { return t(i) + "," + x(i) + ",imu_link"; }),
            "holds text");
  list.good("an empty column", "left out",
            odd_table("t,x,y\n", [](int i) { return t(i) + "," + x(i) + ","; }), "y")
      .channels = 1;
  {
    OddFile& one =
        list.good("NaN, inf, null, empty values", "left out: four more stretches",
                  odd_table("t,x\n",
                            [](int i) {
                              const char* const odd[] = {"nan", "inf", "null", ""};
                              return t(i) + "," + (i % 80 == 79 && i < 320 ? odd[i / 80] : x(i));
                            }),
                  "misses 4 values");
    one.stretches = 5;
    one.used = kOddRows - 4;
  }
  {
    OddFile& one = list.good(
        "a row that cannot be read", "left out: cut there",
        odd_table("t,x\n", [](int i) { return i == 200 ? "2.00,abc" : t(i) + "," + x(i); }),
        "1 row cannot be read");
    one.stretches = 2;
    one.used = kOddRows - 1;
  }
  {
    OddFile& one =
        list.good("a last row that was cut off", "left out",
                  odd_table("t,x\n", [](int i) { return t(i) + "," + x(i); }) + "4.0", "");
    one.used = kOddRows;
  }
  list.good("decimal commas between semicolons", "100 Hz",
            odd_table("t;x\n",
                      [](int i) { return fmt::format("{},{:02};0,{}", i / 100, i % 100, i % 7); }),
            "");
  list.refused(
      "decimal commas in quotes between commas", "refused: write decimal points",
      odd_table("t,x\n", [](int i) { return fmt::format("{},\"0,{}\"", 0.01 * i, i % 7); }),
      "decimal");
  list.good("vertical bars", "100 Hz", odd_table("t|x\n", [](int i) { return t(i) + "|" + x(i); }),
            "");
  list.good("line ends of old Macs (CR)", "100 Hz",
            with_cr(odd_table("t,x\n", [](int i) { return t(i) + "," + x(i); })), "");
  list.good("a header in Latin-1", "100 Hz, the unit too",
            odd_table("t;gyro_x (\xb0/s)\n", [](int i) { return t(i) + ";" + x(i); }), "");
  list.good(
      "a measurement file of LabVIEW", "its head and its column for comments are left out",
      odd_table("LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\n"
                "***End_of_Header***\t\n\t\nChannels\t1\t\nSamples\t400\t\nDelta_X\t0.01\t\n"
                "***End_of_Header***\t\t\nX_Value\tx\tComment\n",
                [](int i) { return t(i) + "\t" + x(i); }),
      "X_Value rises steadily");
  list.good("a name with a unit and no axis: `gyro_rad_s`", "rad/s",
            odd_table("t,gyro_rad_s\n", [](int i) { return t(i) + "," + x(i); }), "rad/s");
  list.good("lines about the device before the table", "left out",
            odd_table("Device: MTi-30\nRate, 100 Hz\n\nt,x,y\n",
                      [](int i) { return t(i) + "," + x(i) + "," + x(i + 1); }),
            "rows 1 to 2 come before the table")
      .channels = 2;
  list.good("rows, but not names, with a trailing comma", "100 Hz",
            odd_table("t,x\n", [](int i) { return t(i) + "," + x(i) + ","; }), "");
  list.good("three columns of one name", "`gyro_x`, `gyro_y`, `gyro_z`",
            odd_table("t,gyro,gyro,gyro\n",
                      [](int i) { return t(i) + "," + x(i) + "," + x(i + 1) + "," + x(i + 2); }),
            "gyro_x to gyro_z")
      .channels = 3;
  list.good("a packet counter", "left out",
            odd_table("PacketCounter,t,x\n",
                      [](int i) { return fmt::format("{},{},{}", i % 256, t(i), x(i)); }),
            "PacketCounter counts");

  // Units.
  list.refused("an unknown unit", "refused: `--unit`",
               odd_table("t,x [cubit]\n", [](int i) { return t(i) + "," + x(i); }), "'cubit'");
  {
    OddFile& one =
        list.good("accelerations in g that state no unit", "g, by their norm",
                  odd_table("t,ax,ay,az\n",
                            [](int i) { return t(i) + "," + x(i) + "," + x(i + 1) + ",1.001"; }),
                  "accelerations ax, ay, az: g");
    one.channels = 3;
  }
  {
    OddFile& one =
        list.good("accelerations in m/s² that are called g", "used, with a warning",
                  odd_table("t,ax [g],ay [g],az [g]\n",
                            [](int i) { return t(i) + "," + x(i) + "," + x(i + 1) + ",9.81"; }),
                  "not 9.81");
    one.channels = 3;
  }
  {
    OddFile& one = list.good("angular rates that state no unit", "used as they are, with a warning",
                             odd_table("t,wx\n", [](int i) { return t(i) + "," + x(i); }),
                             "no unit is stated");
    one.channels = 1;
  }
  {
    OddFile& one = list.good(
        "counts, with `--unit 'gx_raw=0.0076 deg/s'`", "the unit times the factor",
        odd_table("t,gx_raw\n", [](int i) { return fmt::format("{},{}", t(i), i * i % 17); }), "");
    one.options.units = {{"gx_raw", parse_unit("0.0076 deg/s").value()}};
  }
  {
    OddFile& one = list.good("increments Δθ, Δv", "divided by the period",
                             odd_table("t,dtheta_x [rad],dvz [m/s]\n",
                                       [](int i) { return t(i) + "," + x(i) + "," + x(i + 1); }),
                             "increments: dtheta_x, dvz, divided by 0.01 s");
    one.channels = 2;
  }

  {
    OddFile& one = list.good(
        "angular rates in deg/s that are called rad/s", "used, with a warning",
        odd_table("t,wx [rad/s]\n", [](int i) { return t(i) + fmt::format(",{}", 2 + i % 3); }),
        "is rad/s the wrong unit?");
    one.told = "wrong unit";
  }
  {
    OddFile& one = list.good(
        "Δv in columns called ax, ay, az, beside rates that state no unit",
        "all divided by the period",
        odd_table(
            "t,wx,ax,ay,az\n",
            [](int i) { return t(i) + "," + x(i) + "," + x(i + 1) + "," + x(i + 2) + ",0.0981"; }),
        "increments: ax, ay, az, wx");
    one.channels = 4;
  }

  // Sensors.
  {
    OddFile& one = list.good("an axis that never changes", "used, with a warning",
                             odd_table(
                                 "t,gyro_x [deg/s],gyro_y [deg/s]\n",
                                 [](int i) { return t(i) + "," + x(i) + ",0.5"; }, 2000),
                             "gyro_y of the angular rates never changes");
    one.channels = 2;
    one.used = 2000;
  }
  {
    OddFile& one = list.good(
        "one of a hundred samples lost throughout", "100 Hz; cut at each loss",
        odd_table(
            "t,wx [rad/s]\n", [](int i) { return t(i + (i + 50) / 99) + "," + x(i); }, 990),
        "1 % of the samples are lost in 10 places");
    one.stretches = 11;
    one.used = 990;
  }
  list.good("two sensors of different rates in one table", "that of the rates; the other is named",
            odd_table("t,wx [rad/s],ax [m/s^2]\n",
                      [](int i) { return t(i) + "," + x(i) + "," + (i % 4 == 0 ? x(i) : ""); }),
            "channel ax (25 Hz) is left out");
  {
    OddFile& one = list.good("a knock of all axes", "left out: two stretches", knocked(),
                             "disturbed from 100 to");
    one.channels = 6;
    one.stretches = 2;
    one.used = 0;  // the test of the preflight counts them
  }
  list.good("every second sample repeated", "used, with a warning",
            odd_table(
                "t,wx [rad/s]\n", [](int i) { return t(i) + "," + x(i / 2 * 2); }, 2000),
            "repeat the sample before")
      .used = 2000;

  // Names.
  list.refused("an empty file", "refused", "", "is empty");
  list.refused("a header and no rows", "refused", "t,x\n", "");
  all.emplace_back(OddFile{"a CSV that is called .npy", "refused: the name promises NumPy",
                           "odd.npy", odd_table("t,x\n", [](int i) { return t(i) + "," + x(i); }),
                           0.0, 0, 0, 0, "is not a NumPy file"});
  all.emplace_back(OddFile{"a CSV that is called .log", "100 Hz", "odd.log",
                           odd_table("t,x\n", [](int i) { return t(i) + "," + x(i); }), 100.0, 1, 1,
                           kOddRows, ""});
  return list.all;
}

class OddFilesTest : public FileTest {};

TEST_F(OddFilesTest, GetWhatTheGuideSays) {
  const std::string guide =
      bytes_in(std::filesystem::path(IMUNOISE_SOURCE_DIR) / "docs/importing.md");
  std::vector<OddFile> all = odd_times();
  for (OddFile& one : odd_layouts()) all.push_back(std::move(one));
  EXPECT_GE(all.size(), 40U);
  for (const OddFile& one : all) {
    EXPECT_NE(guide.find("| " + one.what + " | " + one.gets + " |"), std::string::npos)
        << "docs/importing.md lacks the row | " << one.what << " | " << one.gets << " |";
    const auto got = import_one(write(one.name, one.content), one.options);
    if (one.rate == 0.0) {
      ASSERT_FALSE(got) << one.what;
      expect_parts(got.error().message, {path(one.name).string(), one.told});
      continue;
    }
    EXPECT_TRUE(got) << one.what << ": " << got.error().message;
    if (!got) continue;
    EXPECT_DOUBLE_EQ(got->front().rate.value, one.rate) << one.what;
    EXPECT_EQ(got->front().channels.size(), one.channels) << one.what;
    EXPECT_EQ(got->size(), one.stretches) << one.what;
    const Preflight& preflight = *got->front().preflight;
    if (one.used > 0) {
      EXPECT_EQ(preflight.used, one.used) << one.what;
    }
    std::string told;
    for (const std::string& said : preflight.recognised) told += said + "\n";
    for (const Finding& found : preflight.findings) told += found.text + "\n";
    EXPECT_NE(told.find(one.told), std::string::npos) << one.what << ": " << told;
  }
}

}  // namespace
}  // namespace imunoise::recording::odd
