// The same against the kernel's own CAN, where it has one.

#include <gtest/gtest.h>

#include <system_error>

#include "drivers/can/presets.h"
#include "tests/drivers/can/as_sent.h"
#include "tests/drivers/lively_source.h"
#include "tests/drivers/recording_session.h"

namespace imunoise::testing {
namespace {

constexpr const char* kInterface = "vcan0";

TEST(VirtualCan, EveryFrameIsDelivered) {
  std::unique_ptr<emulator::SocketCanLine> line;
  try {
    line = std::make_unique<emulator::SocketCanLine>(kInterface);
  } catch (const std::system_error& error) {
    GTEST_SKIP() << "SKIPPED: " << error.what()
                 << "; as root: ip link add dev vcan0 type vcan && ip link set vcan0 up";
  }
  LivelySource source;
  const emulator::CanImu imu(*drivers::make_preset("mti600"), 200.0, source, *line);
  const auto session =
      RecordingSession::open(IMUNOISE_DRIVER_FOLDER, "can",
                             {{"interface", kInterface}, {"preset", "mti600"}, {"rate", "200"}});
  ASSERT_TRUE(session) << session.error().message;
  for (std::size_t s = 0; s < (*session)->info().streams.size(); ++s) {
    ASSERT_TRUE((*session)->read_rows(100, s)) << (*session)->failure();
    expect_as_sent(**session, s, imu.sent());
    EXPECT_EQ((*session)->all_refused(s), 0U);
  }
}

}  // namespace
}  // namespace imunoise::testing
