// Every frame that an emulated IMU puts on the bus, through the plugin.

#include "tests/drivers/can/imu_fixture.h"

namespace imunoise::testing {
namespace {

using drivers::CanFrame;

class CanPresetsOnTheBus : public CanImuTest, public ::testing::WithParamInterface<std::string> {};

TEST_P(CanPresetsOnTheBus, EveryFrameIsDelivered) {
  plug_in(*drivers::make_preset(GetParam()), 200.0);
  const auto session = open({{"preset", GetParam()}, {"listen", "0.2"}});
  ASSERT_TRUE(session) << session.error().message;
  EXPECT_EQ((*session)->info().product, GetParam());
  for (std::size_t s = 0; s < (*session)->info().streams.size(); ++s) {
    EXPECT_NEAR((*session)->info().streams[s].nominal_rate_hz, 200.0, 20.0);
    ASSERT_TRUE((*session)->read_rows(60, s)) << (*session)->failure();
  }
  const auto sent = imu_->sent();
  EXPECT_GE((*session)->info().streams.size(), 3U);
  for (std::size_t s = 0; s < (*session)->info().streams.size(); ++s) {
    expect_as_sent(**session, s, sent);
    EXPECT_EQ((*session)->all_refused(s), 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(All, CanPresetsOnTheBus, ::testing::Values("mti600", "aceinna", "mm5.10"),
                         [](const auto& test) {
                           return test.param == "mm5.10" ? "mm5_10" : test.param;
                         });

// Both byte orders, every type, CAN FD, a counter that is 0 again after 14.
constexpr const char* kWide = R"dbc(
BO_ 291 Wide: 24 IMU
 SG_ Count : 0|4@1+ (1,0) [0|0] "" HOST
 SG_ Rate : 8|32@1- (1E-08,0) [0|0] "rad/s" HOST
 SG_ Acc : 47|20@0- (0.0001,0) [0|0] "m/s2" HOST
 SG_ Big : 64|32@1+ (1e-6,-1000) [0|0] "m/s2" HOST
 SG_ Float : 96|32@1- (1,0) [0|0] "deg/s" HOST
 SG_ Double : 128|64@1- (1,0) [0|0] "degC" HOST
SIG_VALTYPE_ 291 Float : 1;
SIG_VALTYPE_ 291 Double : 2;
BO_ 2566849153 Slow: 2 IMU
 SG_ T : 0|16@1- (0.01,20) [0|0] "degC" HOST
)dbc";
const std::vector<std::string> kWideChannels = {
    "counter=Wide.Count,last=14", "gyro_x=Wide.Rate",       "acc_y=Wide.Acc", "acc_z=Wide.Big",
    "gyro_y=Wide.Float",          "temperature=Wide.Double"};

using CanSamples = CanImuTest;

TEST_F(CanSamples, NumbersStayAsTheBusCarriesThem) {
  plug_in(channels(kWide, kWideChannels), 200.0);
  Options options = describe(kWide, kWideChannels);
  options.push_back({"rate", "200"});
  options.push_back({"listen", "0.2"});
  const auto session = open(options);
  ASSERT_TRUE(session) << session.error().message;
  ASSERT_EQ((*session)->info().streams.size(), 1U);
  const drivers::Stream& stream = (*session)->info().streams[0];
  EXPECT_EQ(stream.nominal_rate_hz, 200.0);
  EXPECT_EQ(stream.counter_maximum, 14U);
  using enum drivers::NumberType;
  const drivers::NumberType types[] = {kInt16, kInt32, kInt32, kInt64, kFloat32, kFloat64};
  ASSERT_EQ(stream.channels.size(), std::size(types));
  for (std::size_t c = 0; c < std::size(types); ++c) EXPECT_EQ(stream.channels[c].type, types[c]);
  EXPECT_EQ(stream.channels[3].scale_factor, 1e-6);
  EXPECT_EQ(stream.channels[3].add_offset, -1000.0);
  EXPECT_EQ(stream.channels[4].units, "deg/s");
  ASSERT_TRUE((*session)->read_rows(100)) << (*session)->failure();
  expect_as_sent(**session, 0, imu_->sent());
  const auto& rows = (*session)->rows();
  for (std::size_t i = 1; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].counter, (rows[i - 1].counter + 1) % 15);
    ASSERT_EQ(rows[i].flags, 0U);
  }
  EXPECT_EQ(rows[0].flags, std::uint32_t{IMUNOISE_SAMPLE_AFTER_RESTART});
}

TEST_F(CanSamples, MessagesThatDoNotComeMakeNoStreamUnlessTheyAreAskedFor) {
  plug_in(channels(kWide, kWideChannels), 200.0);
  Options options = describe(kWide, {});
  options.push_back({"listen", "0.1"});
  const auto session = open(options);
  ASSERT_TRUE(session) << session.error().message;
  ASSERT_EQ((*session)->info().streams.size(), 1U);
  EXPECT_EQ((*session)->info().streams[0].name, "Wide");

  auto both = kWideChannels;
  both.push_back("temperature_2=Slow.T");
  options = describe(kWide, both);
  options.push_back({"listen", "0.1"});
  const auto missing = open(options);
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("no message Slow (0x18ff0281) in 0.1 s"),
            std::string::npos)
      << missing.error().message;
}

constexpr const char* kPages = R"dbc(
BO_ 100 Paged: 4 IMU
 SG_ Page M : 0|8@1+ (1,0) [0|0] "" HOST
 SG_ X m0 : 8|16@1- (0.5,0) [0|0] "deg/s" HOST
 SG_ Y m1 : 8|16@1- (0.5,0) [0|0] "deg/s" HOST
 SG_ Z m1 : 24|8@1- (0.5,0) [0|0] "deg/s" HOST
)dbc";

CanFrame frame(std::uint32_t id, std::vector<std::uint8_t> data) {
  CanFrame out;
  out.id = id;
  out.length = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), out.bytes.begin());
  return out;
}

// Sends frames again and again until the driver has listened to them.
class CanByHand : public CanImuTest {
 protected:
  std::unique_ptr<RecordingSession> open_while_sending(const Options& options,
                                                       const std::vector<CanFrame>& frames) {
    std::jthread sender([&](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        for (const CanFrame& each : frames) bus_.send(each);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
    });
    auto session = open(options);
    sender.request_stop();
    sender.join();
    EXPECT_TRUE(session) << session.error().message;
    if (!session) return nullptr;
    // What was sent between listening and now.
    (*session)->read_until([] { return false; }, std::chrono::milliseconds(50));
    return std::move(*session);
  }
};

TEST_F(CanByHand, EachPageOfAMultiplexedMessageIsAStream) {
  Options options = describe(kPages, {"gyro_x=Paged.X", "gyro_y=Paged.Y", "gyro_z=Paged.Z"});
  options.push_back({"listen", "0.1"});
  const auto session =
      open_while_sending(options, {frame(100, {0, 6, 0, 0}), frame(100, {1, 8, 0, 2})});
  ASSERT_NE(session, nullptr);
  ASSERT_EQ(session->info().streams.size(), 2U);
  EXPECT_EQ(session->info().streams[0].name, "Paged_m0");
  EXPECT_EQ(session->info().streams[1].name, "Paged_m1");
  const std::size_t before[] = {session->rows(0).size(), session->rows(1).size()};
  for (std::uint8_t value = 1; value <= 3; ++value) {
    bus_.send(frame(100, {1, value, 0xff, value}));
    bus_.send(frame(100, {2, 0, 0, 0}));  // a page that nobody wants
  }
  ASSERT_TRUE(session->read_rows(before[1] + 3, 1));
  EXPECT_EQ(session->rows(0).size(), before[0]);
  EXPECT_EQ(session->rows(1).back().numbers, (std::vector<double>{0xff03 - 0x10000, 3.0}));
  EXPECT_EQ(session->all_refused(0) + session->all_refused(1), 0U);
}

TEST_F(CanByHand, WhatIsNoSampleIsCounted) {
  const auto session =
      open_while_sending({{"preset", "aceinna"}, {"address", "129"}, {"listen", "0.1"}}, [] {
        CanFrame rate = frame(0x0cf02a81, std::vector<std::uint8_t>(8, 0x11));
        rate.extended = true;
        return std::vector{rate};
      }());
  ASSERT_NE(session, nullptr);
  ASSERT_EQ(session->info().streams.size(), 1U);
  const std::size_t before = session->rows().size();
  CanFrame rate = frame(0x0cf02a81, {0, 0xfb, 2, 2, 3, 3, 0, 0});  // the first is "not valid"
  rate.extended = true;
  bus_.send(rate);
  rate.length = 5;  // too short
  bus_.send(rate);
  rate.length = 8;
  rate.remote = true;  // a question
  bus_.send(rate);
  rate.remote = false;
  rate.id += 1;  // of another unit
  bus_.send(rate);
  rate.id -= 1;
  rate.bytes[1] = 1;
  bus_.send(rate);
  ASSERT_TRUE(session->read_rows(before + 1));
  EXPECT_EQ(session->rows().back().numbers, (std::vector<double>{0x100, 0x202, 0x303}));
  EXPECT_EQ(session->refused(IMUNOISE_REFUSED_FAULT), 1U);
  EXPECT_EQ(session->refused(IMUNOISE_REFUSED_MALFORMED), 1U);
  EXPECT_EQ(session->all_refused(), 2U);
}

}  // namespace
}  // namespace imunoise::testing
