// The driver "can": IMUs on a CAN bus, by SocketCAN.

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "drivers/can/channel_options.h"
#include "drivers/can/codec/presets.h"
#include "drivers/can/device.h"
#include "drivers/plugin.h"

namespace imunoise::can {
namespace {

drivers::DriverInfo describe_driver() {
  using enum drivers::OptionType;
  const auto presets = drivers::preset_names();
  return {
      "can",
      "IMUs on a CAN or CAN FD bus (SocketCAN), described by a DBC file or a preset",
      IMUNOISE_VERSION,
      {
          {.name = "interface",
           .type = kText,
           .description = "CAN interface, up and at the bit rate of the IMU, such as can0",
           .required = true},
          {.name = "preset",
           .type = kText,
           .description = "Known IMU",
           .choices = {presets.begin(), presets.end()}},
          {.name = "dbc",
           .type = kText,
           .description = "DBC file that describes the messages of the IMU"},
          {.name = "channel",
           .type = kText,
           .description = "Signal to record, such as gyro_x=RateOfTurn.X (default: all of the dbc "
                          "file); append ,unit=UNIT,invalid=NUMBER,last=NUMBER",
           .repeated = true},
          {.name = "rate",
           .type = kNumber,
           .description = "Rate of the fastest message (default: measured, to three digits)",
           .unit = "Hz",
           .minimum = 0.001,
           .maximum = 100000.0},
          {.name = "listen",
           .type = kNumber,
           .description = "Time to listen for messages at the start",
           .unit = "s",
           .by_default = "1",
           .minimum = 0.1,
           .maximum = 60.0},
          {.name = "address",
           .type = kInteger,
           .description = "J1939 source address of an ACEINNA unit",
           .by_default = fmt::format("{}", drivers::kAceinnaAddress),
           .minimum = 0,
           .maximum = 253},
      },
  };
}

std::unique_ptr<plugin::Device> open_device(const plugin::Options& options,
                                            const plugin::Host& host) {
  Settings settings{options.text("interface"), channels_of(options), {}, false, {}, {}};
  settings.product = options.has("preset") ? options.text("preset") : options.text("dbc");
  settings.all_required = options.has("channel");
  if (options.has("rate")) settings.rate_hz = options.number("rate");
  settings.listen = std::chrono::milliseconds(std::llround(options.number("listen") * 1e3));
  return std::make_unique<CanDevice>(std::move(settings), host);
}

}  // namespace
}  // namespace imunoise::can

IMUNOISE_DRIVER(imunoise::can::describe_driver, imunoise::can::open_device)
