// Text tables: delimiters, headers, units, comments, times.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>

#include "core/support/units.h"
#include "recording/import/text/line_reader.h"
#include "recording/import/text/text_table.h"
#include "tests/recording/files.h"

namespace imunoise::recording {
namespace {

class Text : public FileTest {};

constexpr double kDegree = 0.017453292519943295;

TEST_F(Text, HeaderWithUnitsAndATimeColumn) {
  std::string text = "time [ms],gyro_x [deg/s],acc_x (m/s²)\n";
  for (int i = 0; i < 50; ++i) text += std::to_string(5 * i) + ",1.5,-2e-3\n";
  const auto got = import_one(write("run.csv", text));
  ASSERT_TRUE(got) << got.error().message;
  ASSERT_EQ(got->size(), 1U);
  const Replicate& run = got->front();
  EXPECT_EQ(run.name, "run");
  EXPECT_EQ(run.rate.value, 200.0);
  ASSERT_EQ(run.channels.size(), 2U);
  EXPECT_EQ(run.channels[0].name, "gyro_x");
  EXPECT_EQ(run.channels[0].unit.quantity, Quantity::kAngularRate);
  const Signal gyro = run.channels[0].signal();
  EXPECT_EQ(gyro.size(), 50U);
  EXPECT_EQ(gyro.rate().value, 200.0);
  EXPECT_DOUBLE_EQ(gyro.value(7), 1.5 * kDegree);
  EXPECT_EQ(run.channels[1].unit.symbol, "m/s^2");
  EXPECT_EQ(run.channels[1].signal().value(49), -2e-3);
}

TEST_F(Text, EveryDelimiterIsDetected) {
  for (const std::string delimiter : {",", ";", "\t", " ", "  \t", ", ", "; "}) {
    const std::string row = "1" + delimiter + "-2.5" + delimiter + "3e2";
    const auto headless = import_one(write("a.txt", repeated(row + "\n")), at_rate(10));
    ASSERT_TRUE(headless) << delimiter << ": " << headless.error().message;
    ASSERT_EQ(headless->front().channels.size(), 3U) << "'" << delimiter << "'";
    EXPECT_EQ(headless->front().channels[2].name, "col3");
    EXPECT_EQ(stored_doubles(headless->front().channels[1]), std::vector<double>(20, -2.5));
    const std::string header = "x [deg/s]" + delimiter + "y (g)" + delimiter + "z\n";
    const auto named = import_one(write("b.txt", header + repeated(row + "\n")), at_rate(10));
    ASSERT_TRUE(named) << delimiter << ": " << named.error().message;
    ASSERT_EQ(named->front().channels.size(), 3U) << "'" << delimiter << "'";
    EXPECT_EQ(named->front().channels[1].name, "y");
    EXPECT_EQ(named->front().channels[1].unit.symbol, "g");
    EXPECT_EQ(named->front().channels[2].unit.quantity, Quantity::kUnknown);
    EXPECT_EQ(named->front().channels[2].unit.symbol, "1");
  }
}

TEST_F(Text, OneColumn) {
  const auto got = import_one(write("a.csv", "\n gyro_x [dps]\n" + repeated(" 1 \n")), at_rate(10));
  ASSERT_TRUE(got) << got.error().message;
  ASSERT_EQ(got->front().channels.size(), 1U);
  EXPECT_EQ(got->front().channels[0].count, 20U);
}

TEST_F(Text, ByteOrderMarkCarriageReturnsCommentsAndQuotes) {
  const auto got = import_one(write("a.csv",
                                    "\xef\xbb\xbf# rate_hz: 819.2\r\n# by hand\r\n\r\n"
                                    "\"gyro, x [deg/s]\",\"say \"\"y\"\"\"\r\n" +
                                        repeated("\"1.5\" , +2\r\n# between\r\n\r\n") + "3,4"));
  ASSERT_TRUE(got) << got.error().message;
  const Replicate& run = got->front();
  EXPECT_EQ(run.rate.value, 819.2);
  ASSERT_EQ(run.channels.size(), 2U);
  EXPECT_EQ(run.channels[0].name, "gyro, x");
  EXPECT_EQ(run.channels[1].name, "say \"y\"");
  EXPECT_EQ(run.channels[0].count, 21U);
  EXPECT_EQ(stored_doubles(run.channels[0])[0], 1.5);
  EXPECT_EQ(stored_doubles(run.channels[1])[20], 4.0);
}

TEST_F(Text, UnitsInARowOfTheirOwn) {
  std::string text = "t,gyro_x,note\ns,deg/s,-\n";
  for (int i = 0; i < 20; ++i) text += std::to_string(0.01 * i) + ",1,2\n";
  const auto got = import_one(write("a.csv", text));
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_EQ(got->front().rate.value, 100.0);
  EXPECT_EQ(got->front().channels[0].unit.symbol, "deg/s");
  EXPECT_EQ(got->front().channels[1].unit.quantity, Quantity::kUnknown);
  EXPECT_EQ(got->front().channels[0].count, 20U);
}

TEST_F(Text, HeaderInAComment) {
  std::string text = "#timestamp [ns],w_RS_S_x [rad s^-1],a_RS_S_x [m s^-2]\n";
  for (int i = 0; i < 30; ++i) {
    text += std::to_string(1403636580838555648LL + 5000000LL * i) + ",-0.1,8.1\n";
  }
  const auto got = import_one(write("a.csv", text));
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_NEAR(got->front().rate.value, 200.0, 0.01);
  ASSERT_EQ(got->front().channels.size(), 2U);
  EXPECT_EQ(got->front().channels[0].name, "w_RS_S_x");
  EXPECT_EQ(got->front().channels[0].unit.symbol, "rad/s");
  EXPECT_EQ(got->front().channels[1].unit.symbol, "m/s^2");
}

TEST_F(Text, DecimalCommas) {
  const auto got =
      import_one(write("a.csv", "t;x [deg/s]\n" + repeated("0,1;-1,5\n", 20)), at_rate(10));
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_EQ(stored_doubles(got->front().channels[0]), std::vector<double>(20, -1.5));
  const auto bare = import_one(write("a.tsv", repeated("0,1\t1,5e2\n")), at_rate(10));
  ASSERT_TRUE(bare) << bare.error().message;
  EXPECT_EQ(stored_doubles(bare->front().channels[1]), std::vector<double>(20, 150.0));
}

TEST_F(Text, SecondsAndNanosecondsMakeOneTime) {
  std::string text = "stamp.sec,stamp.nanosec,x\n";
  for (int i = 0; i < 300; ++i)
    text += std::to_string(1'700'000'000 + i / 100) + "," +
            std::to_string(i % 100 * 10'000'000 + 7) + ",1\n";
  ImportOptions options;
  write("a.csv", text);
  std::atomic<double> done = 0.0;
  const Progress progress;
  FileProgress own(progress, done, 1);
  const auto table = read_text_table(path("a.csv"), options, own);
  ASSERT_TRUE(table) << table.error().message;
  const auto& stamps = std::get<std::vector<std::int64_t>>(table->time->stamps);
  EXPECT_EQ(stamps[101], 1'700'000'001'010'000'007LL);
  EXPECT_EQ(table->columns.size(), 1U);
}

// A first column that does not rise is a channel; so is one that counts, where the rate is given.
TEST_F(Text, OnlyWhatRisesIsTakenForTheTime) {
  std::string text = "a,b\n";
  for (int i = 0; i < 40; ++i) text += std::to_string(i % 7) + "," + std::to_string(i) + "\n";
  expect_parts(error_of(write("a.csv", text)), {"--rate HZ"});
  const auto got = import_one(write("a.csv", text), at_rate(10));
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_EQ(got->front().channels.size(), 2U);
}

// Rows of another length than the names are no preamble.
TEST_F(Text, AHeaderThatDoesNotSuitTheRowsIsNotSkipped) {
  std::string text = "t,x,y\n";
  for (int i = 0; i < 40; ++i) text += std::to_string(0.01 * i) + ",1\n";
  expect_parts(error_of(write("a.csv", text)), {"2 values where the table has 3 columns"});
}

TEST_F(Text, UnwantedColumnsMayHoldAnything) {
  const auto file = write("a.csv", ",state,x,y,\n" + repeated("0,\"on, ok\",1,nan,\n"));
  ImportOptions options = at_rate(10);
  options.channels = {"x"};
  const auto got = import_one(file, options);
  ASSERT_TRUE(got) << got.error().message;
  ASSERT_EQ(got->front().channels.size(), 1U);
  EXPECT_EQ(got->front().channels[0].name, "x");
  EXPECT_EQ(stored_doubles(got->front().channels[0]), std::vector<double>(20, 1.0));
}

TEST_F(Text, WhatStandsBesideIsReadWhateverItsUnit) {
  const auto file = write(
      "a.csv", "gyro_x [deg/s],count [ticks],baro [Pa],gyro_y [deg/s]\n" + repeated("1,2,3,4\n"));
  ImportOptions options = at_rate(10);
  options.channels = {"gyro_y"};
  options.beside = true;
  const auto got = import_one(file, options);
  ASSERT_TRUE(got) << got.error().message;
  std::vector<std::string> names;
  for (const Channel& one : got->front().channels) names.push_back(one.name);
  EXPECT_EQ(names, (std::vector<std::string>{"gyro_y", "gyro_x", "baro"}));
  EXPECT_EQ(got->front().channels[2].unit.symbol, "Pa");
  EXPECT_EQ(got->front().channels[2].unit.quantity, Quantity::kUnknown);
  options.witnesses = {"count"};
  const auto only = import_one(file, options);
  ASSERT_TRUE(only) << only.error().message;
  ASSERT_EQ(only->front().channels.size(), 2U);
  EXPECT_EQ(only->front().channels[1].name, "count");
  options.witnesses = {"nobody"};
  EXPECT_FALSE(import_one(file, options));
  options.witnesses.clear();
  options.channels = {"baro"};
  const auto named = import_one(file, options);
  ASSERT_FALSE(named);
  EXPECT_NE(named.error().message.find("Pa"), std::string::npos) << named.error().message;
}

TEST_F(Text, ChannelsComeInTheOrderWantedAndOnce) {
  ImportOptions options = at_rate(10);
  options.channels = {"z", "x", "z"};
  const auto got = import_one(write("a.csv", "x,y,z\n" + repeated("1,2,3\n")), options);
  ASSERT_TRUE(got) << got.error().message;
  ASSERT_EQ(got->front().channels.size(), 2U);
  EXPECT_EQ(stored_doubles(got->front().channels[0])[0], 3.0);
  EXPECT_EQ(stored_doubles(got->front().channels[1])[0], 1.0);
}

TEST_F(Text, AnAxisHasManyNames) {
  const auto file = write("a.csv", "gyro_x [deg/s],gyro_y [deg/s]\n" + repeated("1,2\n"));
  ImportOptions options = at_rate(10);
  for (const char* const name : {"gyr_y", "wy", "angular_velocity.y"}) {
    options.channels = {name};
    const auto got = import_one(file, options);
    ASSERT_TRUE(got) << got.error().message;
    ASSERT_EQ(got->front().channels.size(), 1U);
    EXPECT_EQ(got->front().channels[0].name, "gyro_y");
  }
  options.channels = {"gyrox"};
  EXPECT_TRUE(import_one(file, options));
  options.channels = {"gryo_x"};
  expect_parts(error_of(file, options), {"no channel 'gryo_x'", "did you mean 'gyro_x'?"});
}

TEST_F(Text, APatternThatMatchesNothingIsTold) {
  ImportOptions options = at_rate(10);
  options.units = {{"gryo_*", *parse_unit("deg/s")}};
  options.strict = true;
  expect_parts(error_of(write("a.csv", "gyro_x,y\n" + repeated("1,2\n")), options),
               {"--unit gryo_*=deg/s: no channel has this name (there are gyro_x, y)"});
}

TEST_F(Text, TheUsersWordWinsOverTheFiles) {
  ImportOptions options = at_rate(50);
  options.units = {{"*", *parse_unit("mg")}};
  std::string text = "t;x [furlong]\n";
  const auto got = import_one(write("a.csv", text + repeated("7;2\n")), options);  // t stands still
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_EQ(got->front().rate.value, 50.0);
  EXPECT_DOUBLE_EQ(got->front().channels[0].signal().value(0), 2 * 9.80665e-3);
}

TEST_F(Text, TheUserMayFixHeaderAndDelimiter) {
  ImportOptions options = at_rate(10);
  options.header = true;
  const auto numbered = import_one(write("a.csv", "1,2\n" + repeated("3,4\n")), options);
  ASSERT_TRUE(numbered) << numbered.error().message;
  EXPECT_EQ(numbered->front().channels[1].name, "2");
  EXPECT_EQ(numbered->front().channels[1].count, 20U);
  options.header = false;
  options.delimiter = '|';
  const auto piped = import_one(write("b.csv", repeated("3|4\n")), options);
  ASSERT_TRUE(piped) << piped.error().message;
  EXPECT_EQ(piped->front().channels.size(), 2U);
}

TEST_F(Text, CelsiusBecomesKelvin) {
  const auto got = import_one(write("a.csv", "temp [°C]\n" + repeated("25\n")), at_rate(1));
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_DOUBLE_EQ(got->front().channels[0].signal().value(3), 298.15);
}

// The block size moves every border between blocks through rows, numbers, line ends and the mark.
TEST_F(Text, TinyBlocksReadWhatBigOnesRead) {
  std::string text = "\xef\xbb\xbftime [s],x [deg/s],\"y\"\r\n";
  for (int i = 0; i < 200000; ++i) {
    text += std::to_string(i / 8 * 1000 + i % 8 * 125) + "e-3," + std::to_string(i % 977 * 0.37) +
            ",-" + std::to_string(i) + (i % 3 == 0 ? "\n" : "\r\n");
    if (i % 50000 == 1) text += "# comment\n";
  }
  const auto file = write("long.csv", text);
  const ImportOptions options;
  const Progress progress;
  std::atomic<double> done = 0.0;
  FileProgress file_progress(progress, done, 1);
  const auto big = read_text_table(file, options, file_progress);
  ASSERT_TRUE(big) << big.error().message;
  ASSERT_TRUE(big->time);
  ASSERT_EQ(size(big->columns[0].samples), 200000U);
  for (const std::size_t block : {13U, 64U, 4099U}) {
    FileProgress own(progress, done, 1);
    const auto small = read_text_table(file, options, own, block);
    ASSERT_TRUE(small) << small.error().message;
    for (std::size_t c = 0; c < 2; ++c) {
      EXPECT_TRUE(small->columns[c].samples == big->columns[c].samples) << block;
    }
  }
}

// Looked at from its beginning for each word, this line takes minutes.
TEST_F(Text, ABracketThatNeverClosesTakesNoTime) {
  const auto start = std::chrono::steady_clock::now();
  const auto file = write("a.txt", "(" + repeated(" a", 250'000) + "\n1 2 3\n");
  expect_parts(error_of(file, at_rate(1)), {"a.txt"});
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

TEST_F(Text, AnEndlessLineIsRefusedInBoundedMemory) {
  const auto file = write("a.txt", std::string(3 << 20, '1'));
  expect_parts(error_of(file, at_rate(1)), {"a.txt", "row 1", "is this a text file"});
}

}  // namespace
}  // namespace imunoise::recording
