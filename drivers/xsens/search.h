#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "drivers/plugin/device.h"
#include "drivers/plugin/wait.h"
#include "drivers/transport/serial_port.h"

namespace imunoise::xsens {

/// A device in its configuration state.
struct FoundDevice {
  std::unique_ptr<transport::SerialPort> port;
  std::uint32_t baud = 0;
};

/// Opens the port and finds the device at one of its baud rates, `wanted` first. A device that does
/// not obey GoToConfig is reset. Where `wanted` is given and the device is found at another rate,
/// it is set to it. `tap` is shown every byte of it. May take up to ten seconds. Throws
/// plugin::DeviceError; IMUNOISE_NOT_FOUND says what was heard.
FoundDevice find_device(const std::string& path, std::optional<std::uint32_t> wanted,
                        const plugin::CancelSignal& cancel, const plugin::WireTap& tap = {});

}  // namespace imunoise::xsens
