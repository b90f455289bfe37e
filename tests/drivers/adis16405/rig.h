#pragma once

// An emulated sensor on an emulated bus, read through the driver, its C interface and the host.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "drivers/adis16405/device.h"
#include "drivers/emulator/measurement/gaussian_source.h"
#include "drivers/emulator/sensors/adis16405.h"
#include "drivers/emulator/usb/usb_bus.h"
#include "drivers/host/device.h"

namespace imunoise::testing {

/// Numbers of a sample in the order of the stream's channels.
using Counts = std::vector<std::int16_t>;

/// All that was delivered and refused of one stream.
struct Received {
  std::vector<Counts> rows;
  std::vector<std::int64_t> times;  // ns
  std::vector<std::uint32_t> flags;
  std::array<std::uint64_t, IMUNOISE_REFUSED_REASONS> refused{};  // of the first channel

  /// Samples that carry this flag.
  std::size_t flagged(std::uint32_t flag) const;
};

enum Stream : std::size_t { kImu, kMagnetometer, kHousekeeping };

/// Channels of each stream as positions in a burst, as the datasheet orders it.
extern const std::array<std::vector<std::size_t>, 3> kPositions;

struct Rig {
  explicit Rig(drivers::usb::Id bridge_id = drivers::adis16405::kFt232hId);
  /// Behind an FT232H, a sensor that always measures the same.
  explicit Rig(const emulator::Measurement& constant);

  /// Opens the device. Throws plugin::DeviceError as the driver does.
  void open(const drivers::adis16405::Choice& choice = {});
  /// Reads until stream "imu" has so many samples, or something else than samples comes.
  drivers::ReadOutcome read(std::size_t imu_samples);
  /// Counts of one stream of what the sensor took.
  std::vector<Counts> taken(Stream stream) const;
  bool noted(const std::string& text) const;

  emulator::GaussianSource source;
  emulator::Adis16405 sensor;
  std::unique_ptr<emulator::UsbPeripheral> bridge;
  emulator::EmulatedBus bus;
  std::vector<std::string> notes;
  drivers::DeviceHandlers handlers;
  std::unique_ptr<drivers::adis16405::Adis16405Device> driver;
  std::unique_ptr<drivers::Device> device;
  std::array<Received, 3> received;

 private:
  Rig(drivers::usb::Id bridge_id, const emulator::Measurement& mean,
      const emulator::Measurement& deviation);
};

/// Moves what the block holds to the end of its stream's. Fails the test where channels of a stream
/// do not account for the same number of samples.
void append(const drivers::SampleBlock& block, std::array<Received, 3>& received);

/// How many of `all` come before `part`, which must follow in it without a hole. Fails the test
/// where it does not.
std::size_t expect_stretch(const std::vector<Counts>& part, const std::vector<Counts>& all);

/// Every row of `part` in `all`, in this order, with holes allowed; fails the test otherwise.
/// Returns the number of holes.
std::size_t expect_in_order(const std::vector<Counts>& part, const std::vector<Counts>& all);

}  // namespace imunoise::testing
