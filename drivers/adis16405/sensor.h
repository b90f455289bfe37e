#pragma once

// The ADIS16405 behind a bridge: its registers, and its start-up.

#include <functional>
#include <string>

#include "drivers/adis16405/bridges/spi_bus.h"
#include "drivers/adis16405/settings.h"

namespace imunoise::drivers::adis16405 {

/// Tells what a person should know.
using Note = std::function<void(const std::string& text)>;

/// The frames that read a register: the second one's answer holds it.
std::array<SpiFrame, 2> register_read_frames(Register address);

/// Registers are for a bus with nothing queued. Throws plugin::DeviceError. Times: ADIS16400/405
/// datasheet Rev. B.
class Sensor {
 public:
  /// Borrows the bus.
  explicit Sensor(SpiBus& bus) : bus_(bus) {}

  /// Resets, asks for the product id, runs the self-test, writes range, filter, rate and data-ready
  /// and reads them back; takes about 0.6 s and leaves the bus at the clock for bursts. Throws
  /// BAD_DEVICE: no answer, another product, self-test failed, a register that does not hold what
  /// was written.
  void start(const Settings& settings, const Note& note);

  std::uint16_t read(Register address);
  void write(Register address, std::uint16_t value);

 private:
  void check_product();
  void run_self_test(const Note& note);
  void configure(const Settings& settings);
  void write_and_check(Register address, std::uint16_t value);
  std::uint16_t exchange(std::span<const SpiFrame> frames);

  SpiBus& bus_;
};

/// "0x0024: flash_update_failed, self_test_failed"
std::string describe_diagnosis(std::uint16_t diagnostic_status);

}  // namespace imunoise::drivers::adis16405
