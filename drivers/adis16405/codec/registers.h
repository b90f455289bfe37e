#pragma once

// The ADIS16405's registers and the 16-bit SPI words that read and write them. Sources:
// ADIS16400/405 datasheet Rev. B; addresses agree with Linux and Satellogic's header.

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/support/result.h"
#include "core/support/units.h"

namespace imunoise::drivers::adis16405 {

/// Addresses of the lower bytes.
enum class Register : std::uint8_t {
  kFlashCount = 0x00,
  kSupply = 0x02,
  kGyroX = 0x04,
  kGyroY = 0x06,
  kGyroZ = 0x08,
  kAccX = 0x0a,
  kAccY = 0x0c,
  kAccZ = 0x0e,
  kMagX = 0x10,
  kMagY = 0x12,
  kMagZ = 0x14,
  kTemperature = 0x16,
  kAuxAdc = 0x18,
  kGyroXOffset = 0x1a,
  kGyroYOffset = 0x1c,
  kGyroZOffset = 0x1e,
  kAccXOffset = 0x20,
  kAccYOffset = 0x22,
  kAccZOffset = 0x24,
  kMagXHardIron = 0x26,
  kMagYHardIron = 0x28,
  kMagZHardIron = 0x2a,
  kMagXSoftIron = 0x2c,
  kMagYSoftIron = 0x2e,
  kMagZSoftIron = 0x30,
  kGpioControl = 0x32,
  kMiscControl = 0x34,
  kSamplePeriod = 0x36,
  kSensitivityAveraging = 0x38,
  kSleepCount = 0x3a,
  kDiagnosticStatus = 0x3c,
  kGlobalCommand = 0x3e,
  kAlarmMagnitude1 = 0x40,
  kAlarmMagnitude2 = 0x42,
  kAlarmSamples1 = 0x44,
  kAlarmSamples2 = 0x46,
  kAlarmControl = 0x48,
  kAuxDac = 0x4a,
  kProductId = 0x56,
};

/// PRODUCT_ID of an ADIS16405: its name in decimal. (The datasheet prints 0x4105: a misprint.)
inline constexpr std::uint16_t kProductId = 0x4015;

/// Values after a reset.
inline constexpr std::uint16_t kDefaultSamplePeriod = 0x0001;
inline constexpr std::uint16_t kDefaultSensitivityAveraging = 0x0402;
inline constexpr std::uint16_t kDefaultMiscControl = 0x0006;  ///< Data-ready on DIO1, active high.

/// Bits of GLOB_CMD.
inline constexpr std::uint16_t kCommandSoftwareReset = 0x0080;
inline constexpr std::uint16_t kCommandFlashUpdate = 0x0008;
/// Bits of MSC_CTRL.
inline constexpr std::uint16_t kMiscMemoryTest = 0x0800;
inline constexpr std::uint16_t kMiscSelfTest = 0x0400;
inline constexpr std::uint16_t kMiscDataReady = 0x0004;
inline constexpr std::uint16_t kMiscDataReadyHigh = 0x0002;

/// The word that asks for all outputs at once; 12 words follow.
inline constexpr std::uint16_t kBurstCommand = 0x3e00;

/// The word that asks for a register; the answer comes with the next word.
constexpr std::uint16_t read_command(Register address) {
  return static_cast<std::uint16_t>(static_cast<unsigned>(address) << 8U);
}

/// The words that write a register: lower byte, upper byte.
constexpr std::array<std::uint16_t, 2> write_commands(Register address, std::uint16_t value) {
  const unsigned first = (0x80U | static_cast<unsigned>(address)) << 8U;
  return {static_cast<std::uint16_t>(first | (value & 0xffU)),
          static_cast<std::uint16_t>((first + 0x100U) | (value >> 8U))};
}

/// Output rate that SMPL_PRD sets; the clock behind it may be 3 % off.
Hertz sample_rate(std::uint16_t sample_period);

/// Fastest SPI clock for reading registers at this SMPL_PRD; bursts never above kBurstClock.
Hertz fastest_spi_clock(std::uint16_t sample_period);
inline constexpr Hertz kBurstClock{1e6};

/// Full scale of the gyroscopes, in °/s: 300, 150 or 75, from SENS_AVG. Error: no valid range, or a
/// range that its filter setting does not permit.
Result<double> gyro_range(std::uint16_t sensitivity_averaging);

/// What the set bits of DIAG_STAT mean, e.g. "self_test_failed". (The order of the three gyro bits
/// is stated in two ways: they are one flag.)
std::vector<std::string_view> diagnosis(std::uint16_t diagnostic_status);

}  // namespace imunoise::drivers::adis16405
