// The layout of ABI 1 on 64-bit machines, as it was published. Fields may be added behind these
// numbers; a change of any of them needs a new IMUNOISE_DRIVER_ABI.

#include <gtest/gtest.h>

#include <cstddef>

#include "drivers/driver.h"

namespace {

TEST(DriverAbi, StaysAsPublished) {
  EXPECT_EQ(IMUNOISE_DRIVER_ABI, 1U);
  EXPECT_EQ(offsetof(imunoise_driver, size), 0U);
  EXPECT_EQ(offsetof(imunoise_driver, abi), 4U);
  EXPECT_EQ(offsetof(imunoise_driver, name), 8U);
  EXPECT_EQ(offsetof(imunoise_driver, option_count), 32U);
  EXPECT_EQ(offsetof(imunoise_driver, options), 40U);
  EXPECT_EQ(offsetof(imunoise_driver, open), 56U);
  EXPECT_EQ(offsetof(imunoise_driver, describe), 64U);
  EXPECT_EQ(offsetof(imunoise_driver, read), 72U);
  EXPECT_EQ(offsetof(imunoise_driver, cancel), 80U);
  EXPECT_EQ(offsetof(imunoise_driver, close), 88U);
  EXPECT_EQ(offsetof(imunoise_host, now_ns), 8U);
  EXPECT_EQ(offsetof(imunoise_host, note), 16U);
  EXPECT_EQ(offsetof(imunoise_host, wire), 24U);
  EXPECT_EQ(offsetof(imunoise_error, capacity), 4U);
  EXPECT_EQ(offsetof(imunoise_error, text), 8U);
  EXPECT_EQ(offsetof(imunoise_option, type), 4U);
  EXPECT_EQ(offsetof(imunoise_option, properties), 8U);
  EXPECT_EQ(offsetof(imunoise_option, name), 16U);
  EXPECT_EQ(offsetof(imunoise_option, default_value), 40U);
  EXPECT_EQ(offsetof(imunoise_option, choices), 48U);
  EXPECT_EQ(offsetof(imunoise_option, maximum), 64U);
  EXPECT_EQ(offsetof(imunoise_option_value, name), 8U);
  EXPECT_EQ(offsetof(imunoise_option_value, integer), 16U);
  EXPECT_EQ(offsetof(imunoise_option_value, text), 32U);
  EXPECT_EQ(offsetof(imunoise_channel, number_type), 4U);
  EXPECT_EQ(offsetof(imunoise_channel, name), 8U);
  EXPECT_EQ(offsetof(imunoise_channel, add_offset), 40U);
  EXPECT_EQ(offsetof(imunoise_stream, channels), 16U);
  EXPECT_EQ(offsetof(imunoise_stream, counter_maximum), 32U);
  EXPECT_EQ(offsetof(imunoise_stream, device_time_tick_s), 40U);
  EXPECT_EQ(offsetof(imunoise_device_info, streams), 8U);
  EXPECT_EQ(offsetof(imunoise_device_info, firmware), 32U);
  EXPECT_EQ(offsetof(imunoise_block, row_capacity), 4U);
  EXPECT_EQ(offsetof(imunoise_block, host_time_ns), 16U);
  EXPECT_EQ(offsetof(imunoise_block, columns), 48U);
  EXPECT_EQ(offsetof(imunoise_block, refused), 56U);
  EXPECT_EQ(offsetof(imunoise_block, stream), 64U);
  EXPECT_EQ(offsetof(imunoise_block, rows), 68U);
}

}  // namespace
