#pragma once

// Emulated devices behind the devices of their real drivers, in one process.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/emulator/effects/modelled_source.h"
#include "drivers/plugin/device.h"

namespace imunoise::emulator {

/// What is recorded.
struct InProcessPlan {
  std::string driver;  ///< "adis16405", "xsens" or "can".
  SourceTexts source;
  std::vector<std::string> faults;  ///< As parse_fault() takes them.
  double speed = 1.0;  ///< adis16405: speed relative to real time; 0 is as fast as possible.
  std::optional<double> length_s = {};  ///< adis16405: ends after so much of its own time.
  std::string preset = "mti600";        ///< can: which IMU.
  std::string serial = {};              ///< Empty: that of the emulated device.
};

/// The driver's own device, started and configured as ever, with an emulated one at the other end
/// of its line. Throws plugin::DeviceError: BAD_OPTION for texts that cannot be read, and what the
/// driver throws.
std::unique_ptr<plugin::Device> open_adis16405(const InProcessPlan& plan, const plugin::Host& host);
std::unique_ptr<plugin::Device> open_on_line(const InProcessPlan& plan, const plugin::Host& host);

}  // namespace imunoise::emulator
