#pragma once

// Captured bytes through the codec of their device.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/adis16405/settings.h"
#include "drivers/can/codec/channels.h"
#include "drivers/plugin.h"

namespace imunoise::replay {

/// Messages one after another, as the driver of the device would take them. One thread at a time.
class WireCodec {
 public:
  WireCodec() = default;
  WireCodec(const WireCodec&) = delete;
  WireCodec& operator=(const WireCodec&) = delete;
  virtual ~WireCodec() = default;

  /// What the driver would say.
  virtual drivers::DeviceInfo info() const = 0;
  /// What its opening found that a person should know, a sentence each.
  virtual std::vector<std::string> notes() const { return {}; }
  /// Goes on to the next message: its time, ns since the first. Nothing: that was the last.
  virtual std::optional<std::int64_t> next() = 0;
  /// Adds what that message holds, or counts why it does not.
  virtual void take(std::int64_t host_time_ns, plugin::Samples& samples) = 0;
};

/// Frames of an Xsens device from its configuration on. Where the capture begins later, the outputs
/// are taken from the first messages. Messages carry no host time: they follow at the device's
/// rate, `rate_hz` where the capture does not tell. Throws plugin::DeviceError (so do the others):
/// NOT_FOUND, BAD_OPTION (nothing to be decoded).
std::unique_ptr<WireCodec> open_xbus(const std::filesystem::path& file,
                                     std::optional<double> rate_hz);
/// Lines of candump -L. Streams are the messages that come in it.
std::unique_ptr<WireCodec> open_candump(const std::filesystem::path& file,
                                        drivers::CanChannels channels, std::string product,
                                        std::optional<double> rate_hz);
/// Bursts of 26 bytes of an ADIS16405 with these registers, at its nominal rate.
std::unique_ptr<WireCodec> open_bursts(const std::filesystem::path& file,
                                       const drivers::adis16405::Settings& settings);

}  // namespace imunoise::replay
