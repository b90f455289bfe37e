// `imunoise decode` as a user runs it.

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "drivers/xsens/codec/messages.h"
#include "drivers/xsens/codec/mtdata2.h"
#include "tests/cli/program.h"

namespace imunoise {
namespace {

using nlohmann::json;

class Decode : public testing::Program {
 protected:
  void write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
  }

  struct Decoded {
    int status;
    std::vector<std::string> lines;   // of standard output
    std::vector<std::string> errors;  // of standard error
  };
  Decoded decode(const std::string& arguments) const {
    const testing::Outcome done = run("decode " + arguments);
    return {done.status, lines_of(done.out), lines_of(done.errors)};
  }

 private:
  static std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> out;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) out.push_back(line);
    return out;
  }
};

std::string xbus_message(std::uint16_t counter) {
  drivers::MtData2Writer writer;
  writer.packet_counter(counter);
  writer.sample_time_fine(10'000U + 100U * counter);
  const std::array rate = {0.5, -0.25, 0.125};
  writer.numbers(drivers::XsensItem::kRateOfTurn, drivers::XsensFormat::kFixed16_32, rate);
  writer.status_word(1U << 11U);
  const auto frame = encode_message(drivers::XsensMessage::kMtData2, writer.payload());
  return {frame.begin(), frame.end()};
}

TEST_F(Decode, PrintsSamplesAndSaysWhatItRefused) {
  std::string bytes = xbus_message(1) + "noise" + xbus_message(2) + xbus_message(5);
  bytes += xbus_message(6);
  bytes.back() = static_cast<char>(bytes.back() + 1);  // its checksum
  write("x.bin", bytes);
  const auto [status, lines, errors] = decode("--format xbus x.bin --json");
  EXPECT_EQ(status, 0);
  ASSERT_EQ(lines.size(), 4U);
  const json first = json::parse(lines[0]);
  EXPECT_EQ(first["time_s"], 1.01);
  EXPECT_EQ(first["clock"], "device");
  EXPECT_EQ(first["counter"], 1);
  EXPECT_EQ(first["values"]["gyro_y"]["value"], -0.25);
  EXPECT_EQ(first["values"]["gyro_y"]["unit"], "rad/s");
  EXPECT_EQ(first["flags"], json({"clip_gyro_x"}));
  const json summary = json::parse(lines[3])["summary"];
  EXPECT_EQ(summary["samples"], 3);
  EXPECT_EQ(summary["lost"], 2);
  EXPECT_EQ(summary["bytes"], bytes.size());
  EXPECT_EQ(summary["refused"]["checksum"]["count"], 1);
  EXPECT_GE(summary["refused"]["outside_messages"]["count"], 5);
}

TEST_F(Decode, SummaryForPeopleGoesToStandardError) {
  write("x.bin", xbus_message(1) + "noise");
  const auto [status, lines, errors] = decode("--format xbus x.bin");
  EXPECT_EQ(status, 0);
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_NE(errors[0].find("1 samples"), std::string::npos);
  EXPECT_NE(errors[1].find("outside_messages"), std::string::npos);
}

TEST_F(Decode, ReadsStandardInputAndPresets) {
  write("c.log", "(1.25) can0 032#0033FF800500");
  const auto [status, lines, errors] = decode("--format candump --preset mti600 - < c.log");
  EXPECT_EQ(status, 0);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(json::parse(lines[0])["source"], "can0");
  EXPECT_EQ(json::parse(lines[0])["values"]["gyro_y"]["value"], -0.25);
}

TEST_F(Decode, ReadsADatabase) {
  write("d.dbc", "BO_ 1 M: 1 I\n SG_ \"\n");
  write("c.log", "(1.0) can0 001#10\n");
  const Decoded bad = decode("--format candump --dbc d.dbc c.log");
  EXPECT_EQ(bad.status, 1);
  EXPECT_NE(bad.errors.at(0).find("d.dbc:2:6:"), std::string::npos) << bad.errors.at(0);
  write("d.dbc", "BO_ 1 M: 1 I\n SG_ T : 0|8@1- (0.5,1) [0|0] \"degC\" H\n");
  const auto [status, lines, errors] = decode("--format candump --dbc d.dbc c.log");
  EXPECT_EQ(status, 0);
  EXPECT_EQ(json::parse(lines.at(0))["values"]["T"]["value"], 9.0 + 273.15);
}

TEST_F(Decode, ReadsBurstsWithTheRangeOfTheRegister) {
  std::string bytes = "\xff\xff";
  for (int i = 0; i < 12; ++i) bytes += "\x80\x64";  // 100 counts, new
  write("b.bin", bytes);
  const auto at = [&](const char* option) {
    const auto lines = decode(std::string("--format adis16405 b.bin ") + option).lines;
    return json::parse(lines.at(0))["values"]["gyro_x"]["value"].get<double>();
  };
  EXPECT_NEAR(at(""), 5.0 * 0.017453292519943295, 1e-12);
  EXPECT_NEAR(at("--sens-avg 0x0204"), 2.5 * 0.017453292519943295, 1e-12);
}

TEST_F(Decode, RefusesWithTheWayOut) {
  write("x.txt", "this is text");
  const auto error = [&](const std::string& arguments, int status) {
    const Decoded done = decode(arguments);
    EXPECT_EQ(done.status, status) << arguments;
    return done.errors.empty() ? std::string() : done.errors.back();
  };
  EXPECT_NE(error("--format xbus x.txt", 1).find("is this xbus?"), std::string::npos);
  EXPECT_NE(error("--format xbus absent.bin", 1).find("No such file"), std::string::npos);
  EXPECT_NE(error("--format candump x.txt", 1).find("--preset"), std::string::npos);
  EXPECT_NE(error("--format adis16405 --sens-avg 0 x.txt", 1).find("0x0402"), std::string::npos);
  error("--format mp3 x.txt", 2);
}

}  // namespace
}  // namespace imunoise
