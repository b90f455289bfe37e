// The same against the kernel's own CAN, where it has one: as root,
//   ip link add dev vcan0 type vcan && ip link set vcan0 mtu 72 up

#include <gtest/gtest.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <system_error>

#include "drivers/can/codec/presets.h"
#include "tests/drivers/can/as_sent.h"
#include "tests/drivers/lively_source.h"
#include "tests/drivers/recording_session.h"

namespace imunoise::testing {
namespace {

constexpr const char* kInterface = "vcan0";

class VirtualCan : public ::testing::Test {
 protected:
  void SetUp() override {
    try {
      line_ = std::make_unique<emulator::SocketCanLine>(kInterface);
    } catch (const std::system_error& error) {
      GTEST_SKIP() << "SKIPPED: " << error.what() << "; this test's head says how to make one";
    }
  }
  static Result<std::unique_ptr<RecordingSession>> open() {
    return RecordingSession::open(
        IMUNOISE_DRIVER_FOLDER, "can",
        {{"interface", kInterface}, {"preset", "mti600"}, {"rate", "200"}, {"listen", "0.3"}});
  }
  // False where only root may.
  static bool set_link(bool up) {
    const int descriptor = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    ifreq request{};
    std::strcpy(request.ifr_name, kInterface);
    bool done = ::ioctl(descriptor, SIOCGIFFLAGS, &request) == 0;
    const auto flags = static_cast<unsigned>(request.ifr_flags);
    request.ifr_flags = static_cast<short>(up ? flags | IFF_UP : flags & ~unsigned{IFF_UP});
    done = done && ::ioctl(descriptor, SIOCSIFFLAGS, &request) == 0;
    ::close(descriptor);
    return done;
  }

  std::unique_ptr<emulator::SocketCanLine> line_;
  LivelySource source_;
};

TEST_F(VirtualCan, EveryFrameIsDelivered) {
  const emulator::CanImu imu(*drivers::make_preset("mti600"), 200.0, source_, *line_);
  const auto session = open();
  ASSERT_TRUE(session) << session.error().message;
  for (std::size_t s = 0; s < (*session)->info().streams.size(); ++s) {
    ASSERT_TRUE((*session)->read_rows(100, s)) << (*session)->failure();
    expect_as_sent(**session, s, imu.sent());
    EXPECT_EQ((*session)->all_refused(s), 0U);
  }
}

TEST_F(VirtualCan, WhatTheQueueHasNoRoomForIsCounted) {
  drivers::CanFrame rate;
  rate.id = 0x32;
  rate.length = 6;
  std::jthread sender([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      line_->send(rate);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  const auto session = open();
  sender.request_stop();
  sender.join();
  ASSERT_TRUE(session) << session.error().message;
  (*session)->read_until([] { return false; }, std::chrono::milliseconds(50));
  const std::size_t before = (*session)->rows().size();
  constexpr std::uint64_t kFlood = 20'000;
  std::uint64_t sent = 0;
  for (std::uint64_t i = 0; i < kFlood; ++i) sent += line_->send(rate) ? 1U : 0U;
  (*session)->read_until([] { return false; }, std::chrono::milliseconds(300));
  sent += line_->send(rate) ? 1U : 0U;  // the kernel tells of losses with the next frame
  const auto lost = [&] { return (*session)->refused(IMUNOISE_REFUSED_OVERRUN); };
  EXPECT_TRUE((*session)->read_until([&] {
    return (*session)->rows().size() - before + lost() == sent;
  })) << (*session)->rows().size() - before
      << " rows and " << lost() << " lost of " << sent;
  EXPECT_GT(lost(), 0U);
  EXPECT_NE((*session)->rows().back().flags & IMUNOISE_SAMPLE_AFTER_GAP, 0U);
}

TEST_F(VirtualCan, TheLinkGoesDownAndUp) {
  const emulator::CanImu imu(*drivers::make_preset("mti600"), 200.0, source_, *line_);
  const auto session = open();
  ASSERT_TRUE(session) << session.error().message;
  ASSERT_TRUE((*session)->read_rows(50));
  if (!set_link(false)) GTEST_SKIP() << "SKIPPED: only root may take " << kInterface << " down";
  EXPECT_TRUE((*session)->read_until([&] { return !(*session)->disconnections().empty(); }));
  const std::size_t before = (*session)->rows().size();
  ASSERT_TRUE(set_link(true));
  ASSERT_TRUE((*session)->read_rows(before + 50)) << (*session)->failure();
  EXPECT_EQ((*session)->disconnections().size(), 1U);
  EXPECT_NE((*session)->rows()[before].flags & IMUNOISE_SAMPLE_AFTER_RESTART, 0U);
}

}  // namespace
}  // namespace imunoise::testing
