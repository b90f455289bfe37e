#pragma once

// Emulated devices for other programs: a driver opens them like real ones.

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "drivers/emulator/effects/modelled_source.h"
#include "drivers/emulator/faults/fault.h"

namespace imunoise::emulator {

/// What to serve, and where.
struct ServePlan {
  std::string driver;  ///< Of the device: "xsens" or "can".
  /// xsens: path of the link to the pseudo-terminal; can: an interface of the kernel (vcan0), or
  /// "unix:PATH".
  std::string place;
  SourceTexts source;  ///< Its rate: the CAN IMU's; an MTi's is the driver's choice.
  std::vector<std::string> faults = {};  ///< As parse_fault() takes them.
  bool fourth_generation = true;         ///< xsens: MTi-G-710, else MTi-G.
  std::string preset = "mti600";         ///< can: which IMU.
};

/// A device that runs, in real time, in a thread of its own, until it is destroyed. Thread-safe.
class ServedDevice {
 public:
  ServedDevice() = default;
  ServedDevice(const ServedDevice&) = delete;
  ServedDevice& operator=(const ServedDevice&) = delete;
  virtual ~ServedDevice() = default;

  /// What to write behind `imunoise record --device`: "xsens port=pty:/tmp/mti".
  virtual std::string device_text() const = 0;
  /// Messages so far.
  virtual std::size_t messages() const = 0;
};

/// Error: a source or fault that cannot be read, a place that cannot be had, a driver whose devices
/// cannot be served (the ADIS16405's are USB, and need the kernel).
Result<std::unique_ptr<ServedDevice>> serve(const ServePlan& plan);

}  // namespace imunoise::emulator
