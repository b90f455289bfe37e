#include "drivers/can/channel_options.h"

#include <string>
#include <utility>
#include <vector>

#include "drivers/can/channel_option.h"
#include "drivers/can/codec/dbc.h"
#include "drivers/can/codec/dbc_file.h"
#include "drivers/can/codec/presets.h"
#include "drivers/plugin/or_throw.h"

namespace imunoise::can {
namespace {

[[noreturn]] void refuse(const std::string& text) {
  throw plugin::DeviceError(IMUNOISE_BAD_OPTION, text);
}

drivers::CanDatabase read_database(const std::string& path) {
  const auto text = drivers::read_dbc_text(path);
  if (!text) throw plugin::DeviceError(IMUNOISE_NOT_FOUND, text.error().message);
  return plugin::or_throw(drivers::parse_dbc(*text, path));
}

}  // namespace

drivers::CanChannels channels_of(const plugin::Options& options) {
  if (options.has("preset") == options.has("dbc")) {
    refuse("choose one of preset=NAME and dbc=FILE: they say what the IMU's messages mean");
  }
  std::vector<drivers::ChannelMapping> mapping;
  for (const std::string& text : options.texts("channel")) {
    mapping.push_back(plugin::or_throw(parse_channel_option(text)));
  }
  if (options.has("dbc")) {
    return plugin::or_throw(
        drivers::CanChannels::make(read_database(options.text("dbc")), mapping));
  }
  const auto address = options.has("address")
                           ? static_cast<std::uint8_t>(options.integer("address"))
                           : drivers::kAceinnaAddress;
  drivers::CanChannels preset =
      plugin::or_throw(drivers::make_preset(options.text("preset"), address));
  if (mapping.empty()) return preset;
  return plugin::or_throw(drivers::CanChannels::make(preset.database(), mapping));
}

}  // namespace imunoise::can
