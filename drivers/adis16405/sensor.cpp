#include "drivers/adis16405/sensor.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "drivers/plugin/device.h"

namespace imunoise::drivers::adis16405 {
namespace {

using namespace std::chrono_literals;
using plugin::DeviceError;

// The pause and clock that low-power mode (SMPL_PRD from 0x0A on) asks for; any mode permits them.
constexpr std::chrono::microseconds kPollPause = 150us;
constexpr Hertz kSafeClock{0.3e6};
constexpr usb::Duration kRegisterTime = 1s;
constexpr usb::Duration kPowerUpTime = 300ms;  // datasheet: 220 ms, in low power 290 ms
constexpr usb::Duration kResetTime = 200ms;    // datasheet: 100 ms, in low power 170 ms
constexpr usb::Duration kSelfTestStep = 20ms;  // datasheet: 12 ms
constexpr int kSelfTestSteps = 10;
constexpr std::uint16_t kSelfTestFlags = 0xfc20;  // of DIAG_STAT
constexpr std::uint16_t kKeptOfMiscControl =
    0x00c0;  // alignment of the accelerometers, g-compensation

SpiFrame frame_of(std::uint16_t word) {
  SpiFrame out{{}, false, kPollPause};
  append_big_endian(out.send, word);
  return out;
}

std::string_view name_of(Register address) {
  switch (address) {
    case Register::kSamplePeriod:
      return "SMPL_PRD";
    case Register::kSensitivityAveraging:
      return "SENS_AVG";
    default:
      return "MSC_CTRL";
  }
}

}  // namespace

std::array<SpiFrame, 2> register_read_frames(Register address) {
  return {frame_of(read_command(address)), frame_of(0)};
}

void Sensor::start(const Settings& settings, const Note& note) {
  bus_.start(kSafeClock);
  bus_.sleep(kPowerUpTime);  // the bridge's plug may be the sensor's
  write(Register::kGlobalCommand, kCommandSoftwareReset);
  bus_.sleep(kResetTime);
  check_product();
  if (settings.self_test) run_self_test(note);
  configure(settings);
  bus_.start({std::min(kBurstClock.value, fastest_spi_clock(settings.sample_period).value)});
}

std::uint16_t Sensor::read(Register address) { return exchange(register_read_frames(address)); }

void Sensor::write(Register address, std::uint16_t value) {
  const auto words = write_commands(address, value);
  exchange(std::array{frame_of(words[0]), frame_of(words[1])});
}

// The answer to the last frame.
std::uint16_t Sensor::exchange(std::span<const SpiFrame> frames) {
  bus_.send(frames);
  std::size_t left = frames.size();
  for (const usb::Duration end = bus_.now() + kRegisterTime; bus_.now() < end;) {
    for (const SpiAnswer& answer : bus_.receive(end - bus_.now())) {
      if (--left == 0) return BigEndianReader(answer.bytes).take<std::uint16_t>();
    }
  }
  throw DeviceError(IMUNOISE_BAD_DEVICE,
                    fmt::format("{}: no answer to an SPI transfer; unplug it and plug it in again",
                                bus_.bridge().name()));
}

void Sensor::check_product() {
  const std::uint16_t product = read(Register::kProductId);
  if (product == kProductId) return;
  if (product == 0 || product == 0xffff) {
    throw DeviceError(IMUNOISE_BAD_DEVICE,
                      fmt::format("ADIS16405 at {}: no answer (PRODUCT_ID reads 0x{:04X}); look at "
                                  "its 5 V supply, at SCLK, DIN, DOUT and CS, and at ground",
                                  bus_.bridge().name(), product));
  }
  throw DeviceError(
      IMUNOISE_BAD_DEVICE,
      fmt::format(
          "ADIS16405 at {}: PRODUCT_ID reads 0x{:04X} (ADIS{}), not 0x{:04X}; if this is an "
          "ADIS16405, bits are lost on the way: shorten the wires",
          bus_.bridge().name(), product, product, kProductId));
}

void Sensor::run_self_test(const Note& note) {
  write(Register::kMiscControl, kDefaultMiscControl | kMiscSelfTest);
  int steps = 0;
  do {
    if (steps++ == kSelfTestSteps) {
      throw DeviceError(IMUNOISE_BAD_DEVICE,
                        "ADIS16405: its self-test does not end; switch it off and on again");
    }
    bus_.sleep(kSelfTestStep);
  } while ((read(Register::kMiscControl) & kMiscSelfTest) != 0);
  const std::uint16_t status = read(Register::kDiagnosticStatus);
  if ((status & kSelfTestFlags) != 0) {
    throw DeviceError(
        IMUNOISE_BAD_DEVICE,
        fmt::format("ADIS16405: self-test failed, DIAG_STAT {}; keep it still and try again, else "
                    "it is broken (self_test=false records all the same)",
                    describe_diagnosis(status)));
  }
  if (status != 0) note("DIAG_STAT " + describe_diagnosis(status));
}

void Sensor::configure(const Settings& settings) {
  const std::uint16_t kept = read(Register::kMiscControl) & kKeptOfMiscControl;
  write_and_check(Register::kMiscControl, kept | kMiscDataReady | kMiscDataReadyHigh);
  write_and_check(Register::kSensitivityAveraging, settings.sensitivity_averaging);
  write_and_check(Register::kSamplePeriod, settings.sample_period);
}

void Sensor::write_and_check(Register address, std::uint16_t value) {
  write(address, value);
  const std::uint16_t got = read(address);
  if (got == value) return;
  throw DeviceError(IMUNOISE_BAD_DEVICE,
                    fmt::format("ADIS16405: {} reads 0x{:04X} after 0x{:04X} was written; bits are "
                                "lost on the way: shorten the wires, look at its supply",
                                name_of(address), got, value));
}

std::string describe_diagnosis(std::uint16_t diagnostic_status) {
  return fmt::format("0x{:04X}: {}", diagnostic_status,
                     fmt::join(diagnosis(diagnostic_status), ", "));
}

}  // namespace imunoise::drivers::adis16405
