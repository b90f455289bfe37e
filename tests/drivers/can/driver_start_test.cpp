// What the driver says when it cannot begin.

#include <linux/can/error.h>

#include "tests/drivers/can/imu_fixture.h"

namespace imunoise::testing {
namespace {

class CanStart : public CanImuTest {
 protected:
  static void expect_refused(const Options& options, const std::string& text) {
    const auto session = open(options);
    ASSERT_FALSE(session);
    EXPECT_NE(session.error().message.find(text), std::string::npos) << session.error().message;
  }
};

TEST_F(CanStart, TheInterfaceIsMissingOrDown) {
  bus_.set_up(false);
  expect_refused({{"preset", "mti600"}}, "can7: is down; bring it up with the IMU's bit rate: ip");
  bus_.unplug();
  expect_refused({{"preset", "mti600"}}, "can7: no such network interface; see: ip");
}

TEST_F(CanStart, StopsListeningWhenNobodyWantsTheDevice) {
  std::stop_source stop;
  const std::jthread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    stop.request_stop();
  });
  const auto begin = std::chrono::steady_clock::now();
  const auto device = testing::RecordingSession::open(
      IMUNOISE_DRIVER_FOLDER, "can",
      {{"interface", "can7"}, {"preset", "mti600"}, {"listen", "60"}}, false, stop.get_token());
  ASSERT_FALSE(device.has_value());
  EXPECT_EQ(device.error().message, "driver can: can7: cancelled");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(1500));
}

TEST_F(CanStart, NothingComes) {
  expect_refused({{"preset", "mti600"}, {"listen", "0.1"}},
                 "no message of the IMU in 0.1 s; is it powered");
  std::jthread noise([&](const std::stop_token& stop) {
    drivers::CanFrame error;
    error.error = true;
    error.id = CAN_ERR_BUSERROR;
    error.length = 8;
    while (!stop.stop_requested()) {
      bus_.send(error);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  expect_refused({{"preset", "mti600"}, {"listen", "0.2"}},
                 "is the interface's bit rate the IMU's");
}

TEST_F(CanStart, TheDescriptionIsWrong) {
  expect_refused({}, "choose one of preset=NAME and dbc=FILE");
  expect_refused({{"dbc", "/nowhere/imu.dbc"}}, "/nowhere/imu.dbc: cannot be read");
  expect_refused({{"preset", "mti600"}, {"channel", "gyro_x=RateOfTurn"}},
                 "write NAME=MESSAGE.SIGNAL");
  expect_refused({{"preset", "mti600"}, {"channel", "gyro_x=RateOfTurn.W"}},
                 "message RateOfTurn has no signal W");
  expect_refused({{"preset", "mti600"}, {"channel", "counter=RateOfTurn.X"}},
                 "not an unsigned whole number");
}

constexpr const char* kSlow = R"dbc(
BO_ 50 Rate: 8 IMU
 SG_ X : 0|16@1- (0.001,0) [0|0] "rad/s" HOST
BO_ 51 Slow: 8 IMU
 SG_ T : 0|16@1- (0.1,0) [0|0] "degC" HOST
)dbc";

// Messages of kSlow while the driver listens: Slow once, Rate often or never.
class CanRate : public CanStart {
 protected:
  Result<std::unique_ptr<RecordingSession>> hear(bool rate_too, Options more,
                                                 const std::vector<std::string>& channels = {}) {
    Options options = describe(kSlow, channels);
    options.push_back({"listen", "0.1"});
    options.insert(options.end(), more.begin(), more.end());
    const std::jthread imu([&](const std::stop_token& stop) {
      while (!send(51) && !stop.stop_requested()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      while (rate_too && !stop.stop_requested()) {
        send(50);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
    });
    return open(options);
  }

 private:
  // False: nobody listens.
  bool send(std::uint32_t id) {
    drivers::CanFrame frame;
    frame.id = id;
    frame.length = 8;
    return bus_.send(frame);
  }
};

TEST_F(CanRate, AMessageThatCameOnceIsLeftOutAndTold) {
  const auto session = hear(true, {});
  ASSERT_TRUE(session) << session.error().message;
  ASSERT_EQ((*session)->info().streams.size(), 1U);
  EXPECT_EQ((*session)->info().streams[0].name, "Rate");
  EXPECT_NE((*session)->notes().find("message Slow (0x33) came once"), std::string::npos)
      << (*session)->notes();
}

TEST_F(CanRate, AMessageThatCameOnceIsRecordedWhereTheRateIsKnown) {
  const auto session = hear(true, {{"rate", "200"}});
  ASSERT_TRUE(session) << session.error().message;
  ASSERT_EQ((*session)->info().streams.size(), 2U);
  const double rate = (*session)->info().streams[1].nominal_rate_hz;
  EXPECT_GT(rate, 0.5);
  EXPECT_LT(rate, 5.0) << "about once in the 0.5 s that it listened";
}

TEST_F(CanRate, TheOnlyMessageHasTheRateThatIsGiven) {
  const auto session = hear(false, {{"rate", "0.5"}});
  ASSERT_TRUE(session) << session.error().message;
  ASSERT_EQ((*session)->info().streams.size(), 1U);
  EXPECT_EQ((*session)->info().streams[0].nominal_rate_hz, 0.5);
}

TEST_F(CanRate, WithoutAnyRateTheDeviceIsRefused) {
  for (const bool named : {false, true}) {
    const auto session =
        hear(false, {},
             named ? std::vector<std::string>{"temperature=Slow.T"} : std::vector<std::string>{});
    ASSERT_FALSE(session);
    EXPECT_NE(session.error().message.find("message Slow (0x33) came once"), std::string::npos)
        << session.error().message;
  }
}

TEST(CanChannelOption, IsReadWhole) {
  const auto read = can::parse_channel_option("gyro_x=Rate.X,unit=deg/s,invalid=0xfb00,last=14");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->channel, "gyro_x");
  EXPECT_EQ(read->message, "Rate");
  EXPECT_EQ(read->signal, "X");
  EXPECT_EQ(read->unit, "deg/s");
  EXPECT_EQ(read->invalid_from, 0xfb00U);
  EXPECT_EQ(read->last, 14U);
  EXPECT_TRUE(can::parse_channel_option("a=B.C")->unit.empty());
  for (const char* wrong : {"", "a", "=B.C", "a=", "a=B", "a=B.", "a=.C", "a=B.C,", "a=B.C,unit",
                            "a=B.C,unit=", "a=B.C,last=x", "a=B.C,last=", "a=B.C,colour=red"}) {
    EXPECT_FALSE(can::parse_channel_option(wrong)) << wrong;
  }
}

}  // namespace
}  // namespace imunoise::testing
