// imunoise drivers, as a user runs it.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

namespace {

std::string output(const std::string& arguments) {
  std::FILE* const pipe = popen(
      ("IMUNOISE_DRIVER_PATH=" IMUNOISE_TEST_PLUGINS "/nan_rate '" IMUNOISE_BINARY "' drivers "
       "--driver-path " IMUNOISE_TEST_PLUGINS "/sound " +
       arguments)
          .c_str(),
      "r");
  std::string out;
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    out.append(buffer.data(), n);
  }
  EXPECT_EQ(pclose(pipe), 0);
  return out;
}

TEST(DriversCommand, ListsDriversAndRefusalsAsJson) {
  const auto report = nlohmann::json::parse(output("--json"));
  ASSERT_GE(report["drivers"].size(), 1U);
  const auto& sound = report["drivers"][0];
  EXPECT_EQ(sound["name"], "sound");
  EXPECT_EQ(sound["options"][0]["unit"], "Hz");
  EXPECT_EQ(sound["options"][0]["default_value"], "100");
  EXPECT_EQ(sound["options"][0]["maximum"], 1000.0);
  EXPECT_EQ(sound["options"][0]["type"], "integer");
  EXPECT_EQ(sound["streams"][0]["counter_maximum"], "65535");
  EXPECT_EQ(sound["streams"][0]["channels"][0]["number_type"], "int16");
  EXPECT_EQ(sound["streams"][0]["channels"][1]["add_offset"], 273.15);
  ASSERT_EQ(report["refused"].size(), 1U);
  EXPECT_EQ(report["refused"][0]["reason"], "stream 0: nominal rate is nan Hz");
  EXPECT_EQ(report["folders"][0], IMUNOISE_TEST_PLUGINS "/sound");
}

TEST(DriversCommand, FindsTheReplayThatWasBuiltWithIt) {
  const auto report = nlohmann::json::parse(output("--json"));
  const auto& drivers = report["drivers"];
  const auto replay = std::find_if(drivers.begin(), drivers.end(),
                                   [](const auto& driver) { return driver["name"] == "replay"; });
  ASSERT_NE(replay, drivers.end());
  EXPECT_TRUE((*replay)["options"][0]["required"]);
  EXPECT_FALSE((*replay)["options"][0].contains("default_value"));
}

TEST(DriversCommand, SaysTheSameToPeople) {
  const std::string text = output("");
  EXPECT_NE(text.find("sound 1.0: A driver in C\n"), std::string::npos) << text;
  EXPECT_NE(text.find("Samples a second (integer, Hz, 1 to 1000, default 100)"), std::string::npos);
  EXPECT_NE(text.find("stream imu at 100 Hz: gyro_x [rad/s], temperature [K]"), std::string::npos);
  EXPECT_NE(text.find("imunoise-nan_rate.so: stream 0: nominal rate is nan Hz"), std::string::npos);
}

}  // namespace
