// The driver "wire": captured bytes of a device, through the codec of its driver.

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "drivers/can/channel_options.h"
#include "drivers/can/codec/presets.h"
#include "drivers/codec/wire_format.h"
#include "drivers/plugin.h"
#include "drivers/plugin/or_throw.h"
#include "drivers/replay/wire/wire_device.h"

namespace imunoise::replay {
namespace {

drivers::DriverInfo describe_driver() {
  using enum drivers::OptionType;
  const auto presets = drivers::preset_names();
  return {
      "wire",
      "Captured bytes as a device: Xbus dumps, logs of candump, bursts of an ADIS16405",
      IMUNOISE_VERSION,
      {
          {.name = "file",
           .type = kText,
           .description = "The capture, e.g. of imunoise record --wire",
           .required = true},
          {.name = "format",
           .type = kText,
           .description = "How its bytes are to be read",
           .required = true,
           .choices = drivers::wire_format_names()},
          {.name = "speed",
           .type = kNumber,
           .description = "Speed relative to real time; 0 is as fast as possible",
           .by_default = "1",
           .minimum = 0.0,
           .maximum = 1e9},
          {.name = "preset",
           .type = kText,
           .description = "candump: an IMU whose messages are known",
           .choices = {presets.begin(), presets.end()}},
          {.name = "dbc", .type = kText, .description = "candump: DBC file with its messages"},
          {.name = "channel",
           .type = kText,
           .description = "candump: as for the driver can",
           .repeated = true},
          {.name = "rate",
           .type = kNumber,
           .description = "candump: of the fastest message (default: as it is heard); xbus: of "
                          "messages, where the capture does not say; adis16405: sampling rate "
                          "(default: 819.2)",
           .unit = "Hz",
           .minimum = 0.001,
           .maximum = 100000.0},
          {.name = "address",
           .type = kInteger,
           .description = "candump: J1939 source address of an ACEINNA unit",
           .minimum = 0,
           .maximum = 253},
          {.name = "gyro_range",
           .type = kText,
           .description = "adis16405: full scale of the gyroscopes",
           .unit = "deg/s",
           .by_default = "300",
           .choices = {"300", "150", "75"}},
      },
  };
}

std::optional<double> rate_of(const plugin::Options& options) {
  if (!options.has("rate")) return std::nullopt;
  return options.number("rate");
}

std::unique_ptr<WireCodec> open_can(const std::string& file, const plugin::Options& options) {
  auto channels = imunoise::can::channels_of(options);
  const std::string product = options.text(options.has("preset") ? "preset" : "dbc");
  return open_candump(file, std::move(channels), product, rate_of(options));
}

std::unique_ptr<WireCodec> open_adis16405(const std::string& file, const plugin::Options& options) {
  drivers::adis16405::Settings settings;
  const auto range = static_cast<unsigned>(std::stoul(options.text("gyro_range")));
  settings.sensitivity_averaging =
      plugin::or_throw(drivers::adis16405::sensitivity_averaging(range, 4));
  if (const auto rate = rate_of(options)) {
    settings.sample_period = plugin::or_throw(drivers::adis16405::sample_period(Hertz{*rate}));
  }
  return open_bursts(file, settings);
}

std::unique_ptr<WireCodec> open_codec(const plugin::Options& options) {
  const std::string file = options.text("file");
  switch (drivers::find_wire_format(options.text("format")).value()) {  // the host checked it
    case drivers::WireFormat::kXbus:
      return open_xbus(file, rate_of(options));
    case drivers::WireFormat::kCandump:
      return open_can(file, options);
    case drivers::WireFormat::kAdis16405:
      break;
  }
  return open_adis16405(file, options);
}

std::unique_ptr<plugin::Device> open_device(const plugin::Options& options,
                                            const plugin::Host& host) {
  return std::make_unique<WireDevice>(open_codec(options), Pace{options.number("speed"), 0.0},
                                      host);
}

}  // namespace
}  // namespace imunoise::replay

IMUNOISE_DRIVER(imunoise::replay::describe_driver, imunoise::replay::open_device)
