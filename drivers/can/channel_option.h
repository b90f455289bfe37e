#pragma once

#include <string_view>

#include "core/support/result.h"
#include "drivers/can/codec/channels.h"

namespace imunoise::can {

/// Reads "gyro_x=RateOfTurn.X", with ",unit=rad/s", ",invalid=0xfb00" and ",last=14" behind it as
/// wanted. Error: what is wrong, and the form.
Result<drivers::ChannelMapping> parse_channel_option(std::string_view text);

}  // namespace imunoise::can
