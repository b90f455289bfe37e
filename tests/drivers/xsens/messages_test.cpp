#include "drivers/xsens/codec/messages.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/drivers/wire.h"

namespace imunoise::drivers {
namespace {

using testing::from_hex;

TEST(XsensMessages, HaveTheDocumentedBytes) {
  EXPECT_EQ(encode_message(XsensMessage::kRequestDeviceId), from_hex("faff000001"));
  EXPECT_EQ(encode_message(XsensMessage::kSetBaudRate), from_hex("faff1800e9"));
  EXPECT_EQ(encode_message(XsensMessage::kGoToMeasurement), from_hex("faff1000f1"));
  EXPECT_EQ(acknowledged_by(XsensMessage::kGoToConfig), 0x31);
}

TEST(XsensMessages, OutputConfigurationReturns) {
  const std::vector<XsensOutput> wanted = {{0x1020, 0xffff}, {0x4020, 100}, {0x8023, 400}};
  const auto bytes = encode_message(XsensMessage::kSetOutputConfiguration, payload_of(wanted));
  EXPECT_EQ(bytes, from_hex("faffc00c1020ffff40200064802301900f"));
  const auto got = decode_output_configuration(Bytes(bytes).subspan(4, 12));
  ASSERT_TRUE(got);
  EXPECT_EQ(*got, wanted);
  EXPECT_FALSE(decode_output_configuration(Bytes(bytes).subspan(4, 11)));
}

TEST(XsensMessages, EveryBaudRateHasACodeOfItsOwn) {
  std::set<std::uint8_t> codes;
  for (const std::uint32_t baud : baud_rates()) {
    const auto code = baud_code_of(baud);
    ASSERT_TRUE(code) << baud;
    codes.insert(*code);
    EXPECT_EQ(baud_rate_of(*code), baud);
  }
  EXPECT_EQ(codes.size(), baud_rates().size());
  EXPECT_EQ(baud_rates().front(), 115200U);
  EXPECT_EQ(baud_rate_of(0x0a), 921600U);
  EXPECT_EQ(baud_rate_of(0x0e), 3686400U);
  EXPECT_FALSE(baud_code_of(123456));
  EXPECT_FALSE(baud_rate_of(0x42));
}

TEST(XsensMessages, SettersCarryTheirNumber) {
  const auto encode = [](XsensMessage message, auto number) {
    return encode_message(message, payload_of(number));
  };
  EXPECT_EQ(encode(XsensMessage::kSetOutputMode, std::uint16_t{0x0006}),
            from_hex("faffd002000629"));
  EXPECT_EQ(encode(XsensMessage::kSetOutputSettings, std::uint32_t{0x80000044}),
            from_hex("faffd2048000004467"));
  EXPECT_EQ(encode(XsensMessage::kSetPeriod, std::uint16_t{1152}), from_hex("faff04020480 77"));
}

}  // namespace
}  // namespace imunoise::drivers
