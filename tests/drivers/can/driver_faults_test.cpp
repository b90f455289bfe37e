// Trouble on the bus, in the controller and in the queue: counted, survived, told.

#include <linux/can/error.h>

#include "drivers/can/bus_trouble.h"
#include "tests/drivers/can/imu_fixture.h"

namespace imunoise::testing {
namespace {

using emulator::Fault;
using Kind = emulator::Fault::Kind;

constexpr const char* kImu = R"dbc(
BO_ 50 Rate: 8 IMU
 SG_ X : 0|16@1- (0.001,0) [0|0] "rad/s" HOST
 SG_ Y : 16|16@1- (0.001,0) [0|0] "rad/s" HOST
 SG_ Count : 32|16@1+ (1,0) [0|0] "" HOST
)dbc";
const std::vector<std::string> kChannels = {"gyro_x=Rate.X", "gyro_y=Rate.Y", "counter=Rate.Count"};
// Samples that go by while the driver starts, however slowly.
constexpr std::uint64_t kListened = 600;  // 1.5 s

class CanFaults : public CanImuTest {
 protected:
  void start(std::vector<Fault> faults = {}) {
    Options options = describe(kImu, kChannels);
    options.push_back({"listen", "0.1"});
    options.push_back({"rate", "400"});
    plug_in(channels(kImu, kChannels), 400.0, std::move(faults));
    auto opened = open(options);
    ASSERT_TRUE(opened) << opened.error().message;
    session_ = std::move(*opened);
  }
  void read_rows(std::size_t count) {
    ASSERT_TRUE(session_->read_rows(count)) << session_->failure();
    expect_as_sent(*session_, 0, imu_->sent());
    const auto& rows = session_->rows();
    restarts_ = gaps_ = 0;
    for (std::size_t i = 1; i < rows.size(); ++i) {
      const bool restart = (rows[i].flags & IMUNOISE_SAMPLE_AFTER_RESTART) != 0;
      const bool gap = (rows[i].flags & IMUNOISE_SAMPLE_AFTER_GAP) != 0;
      restarts_ += restart ? 1U : 0U;
      gaps_ += gap ? 1U : 0U;
      ASSERT_TRUE(restart || gap || rows[i].counter == rows[i - 1].counter + 1) << i;
    }
  }
  std::size_t lost() const {
    const auto& rows = session_->rows();
    return rows.back().counter - rows.front().counter + 1 - rows.size();
  }

  std::unique_ptr<RecordingSession> session_;
  std::size_t restarts_ = 0;  // after the first
  std::size_t gaps_ = 0;
};

TEST_F(CanFaults, ABitErrorIsAnErrorFrameAndCostsNothing) {
  start({{Kind::kBitError, kListened + 20, 1, 0}});
  read_rows(kListened + 140);
  EXPECT_EQ(lost(), 0U);
  EXPECT_NE(session_->notes().find("so far 1 error frames (1 bus error, 1 protocol violation)"),
            std::string::npos)
      << session_->notes();
}

TEST_F(CanFaults, LostFramesAndAShortStallAreGaps) {
  start({{Kind::kLoss, kListened + 20, 1, 0}, {Kind::kStall, kListened + 60, 30, 0}});
  read_rows(kListened + 140);
  EXPECT_EQ(lost(), 31U);
  EXPECT_EQ(gaps_, 2U);
  EXPECT_EQ(session_->all_refused(), 0U);
}

TEST_F(CanFaults, LateFramesAreNotLost) {
  start({{Kind::kLate, kListened + 20, 40, 0}});
  read_rows(kListened + 140);
  EXPECT_EQ(lost(), 0U);
  EXPECT_EQ(gaps_ + restarts_, 0U);
}

TEST_F(CanFaults, AShortBusOffIsAGap) {
  start({{Kind::kUnplug, kListened + 20, 40, 0}});
  read_rows(kListened + 140);
  EXPECT_EQ(lost(), 40U);
  EXPECT_TRUE(session_->disconnections().empty());
  EXPECT_NE(session_->notes().find("1 bus-off"), std::string::npos) << session_->notes();
}

TEST_F(CanFaults, ALongBusOffIsTold) {
  start({{Kind::kUnplug, kListened + 20, 900, 0}});  // 2.25 s
  read_rows(kListened + 140);
  ASSERT_EQ(session_->disconnections().size(), 1U);
  EXPECT_NE(session_->disconnections()[0].find("went off the bus"), std::string::npos);
  EXPECT_NE(session_->notes().find("the IMU sends again"), std::string::npos);
  EXPECT_EQ(restarts_, 1U);
}

TEST_F(CanFaults, TheLinkGoesDownAndUp) {
  start();
  read_rows(50);
  bus_.set_up(false);
  ASSERT_TRUE(session_->read_until([&] { return session_->disconnections().size() == 1; }));
  EXPECT_NE(session_->disconnections()[0].find("ip link set can7 up"), std::string::npos);
  const std::size_t before = session_->rows().size();
  EXPECT_FALSE(session_->read_until([&] { return session_->rows().size() > before; },
                                    std::chrono::milliseconds(300)));
  bus_.set_up(true);
  read_rows(before + 50);
  EXPECT_EQ(restarts_, 1U);
  EXPECT_EQ(session_->disconnections().size(), 1U);
  EXPECT_NE(session_->notes().find("the interface is back"), std::string::npos);
}

TEST_F(CanFaults, TheAdapterIsUnpluggedAndBack) {
  start();
  read_rows(50);
  bus_.unplug();
  ASSERT_TRUE(session_->read_until([&] { return session_->disconnections().size() == 1; }));
  const std::size_t before = session_->rows().size();
  bus_.plug_in();
  read_rows(before + 50);
  EXPECT_EQ(restarts_, 1U);
}

TEST_F(CanFaults, FramesThatTheQueueHadNoRoomForAreCounted) {
  start();
  read_rows(30);
  bus_.lose(3);
  read_rows(session_->rows().size() + 50);
  EXPECT_EQ(session_->refused(IMUNOISE_REFUSED_OVERRUN), 3U);
  EXPECT_EQ(session_->all_refused(), 3U);
  EXPECT_EQ(gaps_, 1U);
  bus_.lose(2);
  read_rows(session_->rows().size() + 50);
  EXPECT_EQ(session_->refused(IMUNOISE_REFUSED_OVERRUN), 5U);
}

TEST(BusTrouble, IsToldAtMostEveryTenSeconds) {
  can::BusTrouble trouble;
  EXPECT_FALSE(trouble.report(0));
  drivers::CanFrame error;
  error.error = true;
  error.id = CAN_ERR_CRTL;
  EXPECT_FALSE(trouble.add_error(error));
  EXPECT_EQ(trouble.report(0), "so far 1 error frames (1 controller), 0 frames lost in the queue");
  error.id = CAN_ERR_BUSOFF;
  EXPECT_TRUE(trouble.add_error(error));
  trouble.add_lost(4);
  EXPECT_FALSE(trouble.report(9'999'999'999));
  EXPECT_EQ(trouble.report(10'000'000'000),
            "so far 2 error frames (1 bus-off, 1 controller), 4 frames lost in the queue");
  EXPECT_FALSE(trouble.report(30'000'000'000));
}

}  // namespace
}  // namespace imunoise::testing
