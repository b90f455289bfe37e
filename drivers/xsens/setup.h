#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "drivers/xsens/codec/frame.h"
#include "drivers/xsens/codec/legacy.h"
#include "drivers/xsens/codec/messages.h"
#include "drivers/xsens/dialogue.h"
#include "drivers/xsens/settings.h"

namespace imunoise::xsens {

/// What a configured device is and sends.
struct Setup {
  std::string product;
  std::string serial;  ///< Device identifier, hexadecimal.
  std::string firmware;
  /// As the device confirms them: outputs of MTData2, or all about legacy MTData.
  std::variant<std::vector<drivers::XsensOutput>, drivers::XsensConfiguration> sends;
};

/// Takes over what an answer tells of the device: its identifier, product code, or firmware.
/// Other messages tell nothing.
void identify_by(const drivers::XbusFrame& answer, Setup& setup);

/// Asks a device in its configuration state who it is, makes it send what the settings say (writing
/// nothing that it has already: its memory wears), and starts the measurement. Throws
/// plugin::DeviceError.
Setup configure(Dialogue& dialogue, const Settings& settings);

}  // namespace imunoise::xsens
