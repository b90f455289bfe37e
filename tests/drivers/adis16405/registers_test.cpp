#include "drivers/adis16405/codec/registers.h"

#include <gtest/gtest.h>

#include "tests/support/golden.h"

namespace imunoise::drivers::adis16405 {
namespace {

using imunoise::testing::read_json;
using nlohmann::json;

TEST(Adis16405Registers, CommandsAreAsTheDatasheetWritesThem) {
  EXPECT_EQ(read_command(Register::kAccX), 0x0a00);
  EXPECT_EQ(read_command(Register::kProductId), 0x5600);
  EXPECT_EQ(read_command(Register::kGlobalCommand), kBurstCommand);
  using Words = std::array<std::uint16_t, 2>;
  EXPECT_EQ(write_commands(Register::kGyroXOffset, 0x1ff6), (Words{0x9af6, 0x9b1f}));
  EXPECT_EQ(write_commands(Register::kMiscControl, kMiscSelfTest), (Words{0xb400, 0xb504}));
  EXPECT_EQ(write_commands(Register::kGlobalCommand, kCommandSoftwareReset),
            (Words{0xbe80, 0xbf00}));
}

TEST(Adis16405Registers, VectorsOfCommandsAgree) {
  IMUNOISE_NEEDS("vectors/wire.json");
  const json entries = read_json("vectors/wire.json")["adis16405_spi"]["spi_commands"];
  // Each word of the vector, and ours in the same order.
  const std::vector<std::uint16_t> ours = {
      kBurstCommand,
      read_command(Register::kAccX),
      read_command(Register::kProductId),
      read_command(Register::kDiagnosticStatus),
      write_commands(Register::kSamplePeriod, 0x0001)[0],
      write_commands(Register::kSensitivityAveraging, 0x0402)[1],
      write_commands(Register::kSensitivityAveraging, 0x0402)[0],
      write_commands(Register::kMiscControl, kMiscMemoryTest)[1],
      write_commands(Register::kMiscControl, kMiscSelfTest)[1],
      write_commands(Register::kGlobalCommand, kCommandSoftwareReset)[0],
      write_commands(Register::kAccXOffset, 0x1f00)[1],
      write_commands(Register::kGyroXOffset, 0x1ff6)[1],
      write_commands(Register::kGyroXOffset, 0x1ff6)[0]};
  ASSERT_EQ(entries.size(), ours.size());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    EXPECT_EQ(ours[i], std::stoul(entries[i]["din"].get<std::string>(), nullptr, 16))
        << entries[i]["meaning"];
  }
}

TEST(Adis16405Registers, VectorsOfSampleRatesAgree) {
  IMUNOISE_NEEDS("vectors/wire.json");
  const json entries = read_json("vectors/wire.json")["adis16405_spi"]["smpl_prd"];
  ASSERT_EQ(entries.size(), 8U);
  for (const json& entry : entries) {
    const auto value = std::stoul(entry["value"].get<std::string>(), nullptr, 16);
    EXPECT_NEAR(sample_rate(static_cast<std::uint16_t>(value)).value, entry["sps"].get<double>(),
                5.1e-5);  // printed with four decimals
  }
}

TEST(Adis16405Registers, RangeFollowsFromSensitivity) {
  EXPECT_EQ(*gyro_range(0x0402), 300.0);
  EXPECT_EQ(*gyro_range(0x0202), 150.0);
  EXPECT_EQ(*gyro_range(0x0104), 75.0);
  for (const unsigned wrong : {0x0002U, 0x0302U, 0x0702U, 0x0201U, 0x0103U}) {
    EXPECT_FALSE(gyro_range(static_cast<std::uint16_t>(wrong))) << wrong;
  }
  EXPECT_NE(gyro_range(0x0103).error().message.find("at least 4"), std::string::npos);
}

TEST(Adis16405Registers, SlowModesNeedASlowClock) {
  EXPECT_EQ(fastest_spi_clock(0x01).value, 2e6);
  EXPECT_EQ(fastest_spi_clock(0x09).value, 2e6);
  EXPECT_EQ(fastest_spi_clock(0x0a).value, 0.3e6);
  EXPECT_EQ(fastest_spi_clock(0x80).value, 0.3e6);
}

TEST(Adis16405Registers, DiagnosisInWords) {
  using Words = std::vector<std::string_view>;
  EXPECT_EQ(diagnosis(0), Words{});
  EXPECT_EQ(diagnosis(0x0021), (Words{"supply_below_4.75_V", "self_test_failed"}));
  EXPECT_EQ(diagnosis(0x1c00), Words{"gyro_self_test_failed"});
  EXPECT_EQ(diagnosis(0x8010), (Words{"overrange", "acc_z_self_test_failed"}));
}

}  // namespace
}  // namespace imunoise::drivers::adis16405
