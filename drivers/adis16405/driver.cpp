// The driver "adis16405": an ADIS16405 behind a USB-SPI bridge.

#include <memory>
#include <string>
#include <utility>

#include "drivers/adis16405/device.h"
#include "drivers/plugin/or_throw.h"
#include "drivers/transport/libusb_bus.h"

namespace imunoise::drivers::adis16405 {
namespace {

DriverInfo describe_driver() {
  using enum OptionType;
  return {
      "adis16405",
      "Analog Devices ADIS16405 behind a USB-SPI bridge (FT232H or CP2130)",
      IMUNOISE_VERSION,
      {
          {.name = "bridge",
           .type = kText,
           .description = "USB-SPI bridge of the sensor",
           .by_default = "any",
           .choices = {"any", "ft232h", "cp2130"}},
          {.name = "serial",
           .type = kText,
           .description = "Serial number of the bridge, where several are plugged in"},
          {.name = "gyro_range",
           .type = kText,
           .description = "Full scale of the gyroscopes",
           .unit = "deg/s",
           .by_default = "300",
           .choices = {"300", "150", "75"}},
          {.name = "filter",
           .type = kInteger,
           .description = "Two moving averages of 2^filter samples each; 75 deg/s needs 4 or more, "
                          "150 deg/s 2 or more",
           .by_default = "2",
           .minimum = 0.0,
           .maximum = 7.0},
          {.name = "rate",
           .type = kNumber,
           .description = "Sampling rate: 1638.4 or 52.85 Hz over a whole number, within 1 %",
           .unit = "Hz",
           .by_default = "819.2",
           .minimum = 0.2,
           .maximum = 819.2},
          {.name = "self_test",
           .type = kFlag,
           .description = "Self-test at the start; a device that fails it is not recorded",
           .by_default = "true"},
          {.name = "poll",
           .type = kFlag,
           .description = "Polling without the data-ready signal (a CP2130 always polls)",
           .by_default = "false"},
      },
      describe_streams({}),
  };
}

std::unique_ptr<plugin::Device> open_device(const plugin::Options& options,
                                            const plugin::Host& host) {
  Choice choice;
  choice.bridge = options.text("bridge");
  if (options.has("serial")) choice.serial = options.text("serial");
  choice.poll = options.flag("poll");
  choice.settings.self_test = options.flag("self_test");
  choice.settings.sample_period = plugin::or_throw(sample_period({options.number("rate")}));
  choice.settings.sensitivity_averaging = plugin::or_throw(
      sensitivity_averaging(static_cast<unsigned>(std::stoul(options.text("gyro_range"))),
                            static_cast<unsigned>(options.integer("filter"))));
  auto bus = std::make_unique<usb::LibusbBus>([host] { return host.now_ns(); });
  return std::make_unique<Adis16405Device>(std::move(bus), std::move(choice), host);
}

}  // namespace
}  // namespace imunoise::drivers::adis16405

IMUNOISE_DRIVER(imunoise::drivers::adis16405::describe_driver,
                imunoise::drivers::adis16405::open_device)
