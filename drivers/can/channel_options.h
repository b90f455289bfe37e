#pragma once

#include "drivers/can/codec/channels.h"
#include "drivers/plugin.h"

namespace imunoise::can {

/// The channels that a user chose by the options preset or dbc, channel, and address where the
/// driver has it. Throws plugin::DeviceError: BAD_OPTION, NOT_FOUND (the DBC file).
drivers::CanChannels channels_of(const plugin::Options& options);

}  // namespace imunoise::can
