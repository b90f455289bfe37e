#include "drivers/iio/channels.h"

#include <gtest/gtest.h>

namespace imunoise::iio {
namespace {

using drivers::NumberType;

TEST(IioChannels, HaveTheNamesAndUnitsOfImunoise) {
  // ADIS16475-2 (kernel driver adis16475): 0.00625 deg/s, in rad/s, over 2^16; 32 bits.
  const auto gyro = describe_channel({"anglvel_x", 0.000000001666, 0.0, 32, true});
  EXPECT_EQ(gyro.name, "gyro_x");
  EXPECT_EQ(gyro.units, "rad/s");
  EXPECT_EQ(gyro.type, NumberType::kInt32);
  EXPECT_EQ(gyro.scale_factor, 0.000000001666);
  EXPECT_EQ(describe_channel({"accel_z", 1.0, 0.0, 16, true}).name, "acc_z");
  EXPECT_EQ(describe_channel({"accel_z", 1.0, 0.0, 16, true}).units, "m/s^2");
  EXPECT_EQ(describe_channel({"magn_y", 1.0, 0.0, 16, true}).units, "gauss");
}

// The kernel adds the offset to the number before it scales, and counts milli-degrees: BMI160, 512
// counts a kelvin around 23 °C.
TEST(IioChannels, OffsetsComeBeforeScales) {
  const auto temperature = describe_channel({"temp", 1.953125, 11776.0, 16, true});
  EXPECT_EQ(temperature.name, "temperature");
  EXPECT_EQ(temperature.units, "degC");
  EXPECT_DOUBLE_EQ(temperature.add_offset, 23.0);
  EXPECT_DOUBLE_EQ(temperature.scale_factor * 512.0 + temperature.add_offset, 24.0);
  EXPECT_EQ(describe_channel({"temp0", 1.0, 0.0, 16, true}).name, "temperature");
}

TEST(IioChannels, TypesHoldEveryNumber) {
  EXPECT_EQ(describe_channel({"accel_x", 1.0, 0.0, 12, true}).type, NumberType::kInt16);
  EXPECT_EQ(describe_channel({"voltage0", 1.0, 0.0, 15, false}).type, NumberType::kInt16);
  EXPECT_EQ(describe_channel({"voltage0", 1.0, 0.0, 16, false}).type, NumberType::kInt32);
  EXPECT_EQ(describe_channel({"voltage0", 1.0, 0.0, 32, false}).type, NumberType::kInt64);
  EXPECT_EQ(describe_channel({"voltage0", 1.0, 0.0, 32, false}).units, "1");
}

TEST(IioChannels, AnImuHasARateAnAccelerationOrAField) {
  EXPECT_TRUE(is_inertial("anglvel_x"));
  EXPECT_TRUE(is_inertial("magn_z"));
  EXPECT_FALSE(is_inertial("temp"));
  EXPECT_FALSE(is_inertial("voltage0"));
}

}  // namespace
}  // namespace imunoise::iio
