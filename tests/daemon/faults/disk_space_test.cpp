#include "daemon/acquire/disk_space.h"

#include <gtest/gtest.h>

namespace imunoise::acquire {
namespace {

v1::RecordedDevice imu() {
  v1::RecordedDevice out;
  v1::RecordedStream& stream = *out.add_streams();
  stream.set_rate_hz(100.0);
  stream.set_counter_modulus(65536);
  for (const char* const dtype : {"<i2", "<i2", "<f8"}) stream.add_channels()->set_dtype(dtype);
  out.add_streams()->add_channels()->set_dtype("<f4");  // at no known rate
  return out;
}

TEST(DiskSpace, CountsTheBytesOfEveryRow) {
  EXPECT_EQ(bytes_per_second(imu()), 100.0 * (8 + 4 + 8 + 2 + 2 + 8));
}

TEST(DiskSpace, NeedsRoomBesideTheReserve) {
  const DiskPlan plan{{imu(), imu()}, 86400.0, 1'000'000'000};
  const double needed = 2.0 * 3200.0 * 86400.0 + 2.0 * 33554432.0;  // and a segment of each device
  const auto free = static_cast<std::uint64_t>(needed) + plan.reserve_bytes;
  EXPECT_TRUE(check_room(plan, free + 1).has_value());
  const auto short_of = check_room(plan, free - 100'000'000);
  ASSERT_FALSE(short_of.has_value());
  EXPECT_NE(short_of.error().message.find("it would be reached in"), std::string::npos)
      << short_of.error().message;
  const auto none = check_room(plan, 1000);
  ASSERT_FALSE(none.has_value());
  EXPECT_NE(none.error().message.find("already in use"), std::string::npos);
}

}  // namespace
}  // namespace imunoise::acquire
