// The driver "iio": IMUs that have a driver in the kernel.

#include <memory>
#include <utility>

#include "drivers/iio/device.h"

namespace imunoise::iio {
namespace {

drivers::DriverInfo describe_driver() {
  using enum drivers::OptionType;
  return {
      "iio",
      "IMUs with a driver in the Linux kernel (Industrial I/O): ADIS164xx, ST, Bosch, InvenSense, "
      "...",
      IMUNOISE_VERSION,
      {
          {.name = "device",
           .type = kText,
           .description =
               "Name (adis16475) or id (iio:device0) of the IMU, where there are several"},
          {.name = "rate",
           .type = kNumber,
           .description = "Sampling rate, where the IMU sets its own (default: unchanged)",
           .unit = "Hz",
           .minimum = 0.001,
           .maximum = 100000.0},
          {.name = "trigger",
           .type = kText,
           .description =
               "Name of the trigger that starts each sample (default: the device's own)"},
      },
  };
}

std::unique_ptr<plugin::Device> open_device(const plugin::Options& options,
                                            const plugin::Host& host) {
  Choice choice;
  if (options.has("device")) choice.device = options.text("device");
  if (options.has("trigger")) choice.trigger = options.text("trigger");
  if (options.has("rate")) choice.rate_hz = options.number("rate");
  return std::make_unique<IioDevice>(std::move(choice), host);
}

}  // namespace
}  // namespace imunoise::iio

IMUNOISE_DRIVER(imunoise::iio::describe_driver, imunoise::iio::open_device)
