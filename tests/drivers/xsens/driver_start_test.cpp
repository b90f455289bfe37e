// Finding a device, configuring it, and saying why not.

#include "drivers/emulator/lines/pty.h"
#include "tests/drivers/xsens/mti_fixture.h"

namespace imunoise::testing {
namespace {

using emulator::MtiOptions;

class MtiStart : public MtiTest {
 protected:
  void expect_refused(const std::vector<drivers::OptionText>& options, const std::string& text) {
    const auto session = open(options);
    ASSERT_FALSE(session);
    EXPECT_NE(session.error().message.find(text), std::string::npos) << session.error().message;
  }
  void expect_samples(const std::vector<drivers::OptionText>& options, const std::string& note) {
    const auto session = open(options);
    ASSERT_TRUE(session) << session.error().message;
    EXPECT_NE((*session)->notes().find(note), std::string::npos) << (*session)->notes();
    EXPECT_TRUE((*session)->read_rows(5));
  }
};

TEST_F(MtiStart, FindsTheBaudRate) {
  MtiOptions options;
  options.baud = 460800;
  plug_in(options);
  expect_samples({}, "at 460800 baud");
}

TEST_F(MtiStart, SetsTheBaudRateThatTheUserWants) {
  plug_in();
  expect_samples({{"baud", "921600"}}, "at 921600 baud");
  expect_samples({}, "at 921600 baud");
}

TEST_F(MtiStart, ResetsADeviceThatDoesNotObey) {
  MtiOptions options;
  options.deaf_until_reset = true;
  plug_in(options);
  expect_samples({}, "MTi-G-710-2A8G4");
}

TEST_F(MtiStart, WritesNothingThatTheDeviceHasAlready) {
  plug_in();
  expect_samples({}, "");
  expect_samples({}, "");
  EXPECT_EQ(mti_->writes(), 1U);
  expect_samples({{"rate", "50"}}, "");
  EXPECT_EQ(mti_->writes(), 2U);
}

TEST_F(MtiStart, ReturnsANewDeviceToLegacyMessages) {
  plug_in();
  const auto session = open({{"protocol", "legacy"}});
  ASSERT_TRUE(session) << session.error().message;
  EXPECT_EQ((*session)->device().info().streams[0].device_time_tick_s, 0.0);  // MTData2 has one
  EXPECT_TRUE((*session)->read_rows(5));
}

TEST_F(MtiStart, SaysWhatTheDeviceCannotDo) {
  MtiOptions options;
  options.fourth_generation = false;
  options.product = "MTi-G-28A53G35";
  plug_in(options);
  expect_refused({{"protocol", "mtdata2"}}, "MTi-G-28A53G35 does not know MTData2; try");
  expect_refused({{"format", "float64"}}, "legacy MTData has no format float64; choose");
  expect_refused({{"baud", "5000"}}, "the device has no 5000 baud; it has 115200,");
}

TEST_F(MtiStart, NamesThePortsWhereThereIsNone) {
  const auto session =
      RecordingSession::open(IMUNOISE_DRIVER_FOLDER, "xsens", {{"port", "/dev/ttyUSB77"}});
  ASSERT_FALSE(session);
  EXPECT_NE(session.error().message.find("/dev/ttyUSB77: no such serial port; there "),
            std::string::npos)
      << session.error().message;
}

TEST_F(MtiStart, TwoCannotHaveOnePort) {
  plug_in();
  const auto first = open();
  ASSERT_TRUE(first) << first.error().message;
  expect_refused({}, "in use by another program");
}

TEST_F(MtiStart, SaysThatAPortIsSilent) {
  const emulator::Pty nobody(link());
  expect_refused({}, "silent at every baud rate; check power");
}

// Knocking at every baud rate takes longer than anybody who wants an end should wait.
TEST_F(MtiStart, StopsKnockingWhenNobodyWantsTheDevice) {
  const emulator::Pty nobody(link());
  std::stop_source stop;
  const std::jthread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    stop.request_stop();
  });
  const auto begin = std::chrono::steady_clock::now();
  const auto device = testing::RecordingSession::open(IMUNOISE_DRIVER_FOLDER, "xsens",
                                                      {{"port", port()}}, false, stop.get_token());
  ASSERT_FALSE(device.has_value());
  EXPECT_NE(device.error().message.find("cancelled"), std::string::npos) << device.error().message;
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(1500));
}

TEST_F(MtiStart, SaysThatSomethingElseTalks) {
  const emulator::Pty line(link());
  std::jthread talker([&](const std::stop_token& stop) {
    const std::vector<std::uint8_t> nmea = {'$', 'G', 'P', 'G', 'G', 'A', '\r', '\n'};
    while (!stop.stop_requested()) {
      line.write(nmea);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
  expect_refused({}, "nothing that answers as an Xsens device");
}

}  // namespace
}  // namespace imunoise::testing
