// The same against the kernel's own CAN, where it has one: as root,
//   ip link add dev vcan0 type vcan && ip link set vcan0 mtu 72 up

#include <gtest/gtest.h>
#include <linux/can/error.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>
#include <thread>

#include "drivers/can/codec/presets.h"
#include "tests/drivers/can/as_sent.h"
#include "tests/drivers/lively_source.h"
#include "tests/drivers/recording_session.h"

namespace imunoise::testing {
namespace {

using namespace std::chrono_literals;

constexpr const char* kInterface = "vcan0";

drivers::CanFrame rate_frame() {
  drivers::CanFrame out;
  out.id = 0x32;  // of the preset mti600: angular rates
  out.length = 6;
  return out;
}

class VirtualCan : public ::testing::Test {
 protected:
  void SetUp() override {
    try {
      line_ = std::make_unique<emulator::SocketCanLine>(kInterface);
    } catch (const std::system_error& error) {
      GTEST_SKIP() << "SKIPPED: " << error.what() << "; this test's head says how to make one";
    }
  }
  static Result<std::unique_ptr<RecordingSession>> open(const char* interface = kInterface) {
    return RecordingSession::open(
        IMUNOISE_DRIVER_FOLDER, "can",
        {{"interface", interface}, {"preset", "mti600"}, {"rate", "200"}, {"listen", "0.3"}});
  }
  // With a sender of angular rates while it opens.
  Result<std::unique_ptr<RecordingSession>> open_on_rates() const {
    std::jthread sender([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        line_->send(rate_frame());
        std::this_thread::sleep_for(5ms);
      }
    });
    auto session = open();
    sender.request_stop();
    sender.join();
    if (session) (*session)->read_until([] { return false; }, 50ms);
    return session;
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
  const drivers::CanFrame rate = rate_frame();
  const auto session = open_on_rates();
  ASSERT_TRUE(session) << session.error().message;
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

// Messages of others fill no queue: the kernel filters them. Those of the same number in the other
// format are others.
TEST_F(VirtualCan, MessagesOfOthersTakeNoRoom) {
  const auto session = open_on_rates();
  ASSERT_TRUE(session) << session.error().message;
  const std::size_t before = (*session)->rows().size();
  drivers::CanFrame other = rate_frame();
  for (int i = 0; i < 20'000; ++i) {
    other.extended = i % 2 == 0;
    other.id = other.extended ? 0x32U : 0x100U;
    line_->send(other);
  }
  ASSERT_TRUE(line_->send(rate_frame()));
  ASSERT_TRUE((*session)->read_rows(before + 1));
  (*session)->read_until([] { return false; }, 100ms);
  EXPECT_EQ((*session)->rows().size(), before + 1);
  EXPECT_EQ((*session)->all_refused(), 0U);
}

// A reader that comes late: the kernel stamped each frame when it came.
TEST_F(VirtualCan, TimesAreTheKernels) {
  const auto session = open_on_rates();
  ASSERT_TRUE(session) << session.error().message;
  const std::size_t before = (*session)->rows().size();
  std::vector<std::int64_t> sent;
  for (int i = 0; i < 5; ++i) {
    sent.push_back(std::chrono::system_clock::now().time_since_epoch() / 1ns);
    ASSERT_TRUE(line_->send(rate_frame()));
    std::this_thread::sleep_for(100ms);
  }
  ASSERT_TRUE((*session)->read_rows(before + sent.size()));
  for (std::size_t i = 0; i < sent.size(); ++i) {
    const std::int64_t late = (*session)->rows()[before + i].host_time_ns - sent[i];
    EXPECT_GE(late, -1'000'000) << i;  // two clocks are compared
    EXPECT_LT(late, 80'000'000) << i;
  }
}

TEST_F(VirtualCan, ErrorFramesAreCounted) {
  const auto session = open_on_rates();
  ASSERT_TRUE(session) << session.error().message;
  drivers::CanFrame error;
  error.error = true;
  error.id = CAN_ERR_PROT | CAN_ERR_BUSERROR;
  error.length = CAN_ERR_DLC;
  ASSERT_TRUE(line_->send(error));
  EXPECT_TRUE((*session)->read_until([&] {
    return (*session)->notes().find("so far 1 error frames (1 bus error, 1 protocol violation)") !=
           std::string::npos;
  })) << (*session)->notes();
  EXPECT_EQ((*session)->all_refused(), 0U);
}

TEST_F(VirtualCan, TheInterfaceIsRemovedAndComesBack) {
  constexpr const char* kOwn = "vcan-own";
  const std::string add =
      std::string("ip link add dev ") + kOwn + " type vcan && ip link set " + kOwn + " mtu 72 up";
  const std::string remove = std::string("ip link delete ") + kOwn;
  if (std::system(add.c_str()) != 0) GTEST_SKIP() << "SKIPPED: only root may add an interface";
  std::optional<emulator::SocketCanLine> line(kOwn);
  std::optional<emulator::CanImu> imu;
  imu.emplace(*drivers::make_preset("mti600"), 200.0, source_, *line);
  const auto session = open(kOwn);
  ASSERT_TRUE(session) << session.error().message;
  ASSERT_TRUE((*session)->read_rows(50));
  imu.reset();
  ASSERT_EQ(std::system(remove.c_str()), 0);
  EXPECT_TRUE((*session)->read_until([&] { return !(*session)->disconnections().empty(); }));
  const std::size_t before = (*session)->rows().size();
  ASSERT_EQ(std::system(add.c_str()), 0);
  line.emplace(kOwn);
  imu.emplace(*drivers::make_preset("mti600"), 200.0, source_, *line);
  EXPECT_TRUE((*session)->read_rows(before + 50)) << (*session)->failure();
  EXPECT_NE((*session)->rows()[before].flags & IMUNOISE_SAMPLE_AFTER_RESTART, 0U);
  imu.reset();
  EXPECT_EQ(std::system(remove.c_str()), 0);
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
