// The driver "text": any device that prints a line a sample.

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "drivers/plugin.h"
#include "drivers/text/device.h"

namespace imunoise::text {
namespace {

drivers::DriverInfo describe_driver() {
  using enum drivers::OptionType;
  return {
      "text",
      "Any device that prints a line a sample: over a serial port, a pipe, TCP, or from a command",
      IMUNOISE_VERSION,
      {
          {.name = "port",
           .type = kText,
           .description = "Serial port that prints the lines, such as /dev/ttyACM0"},
          {.name = "baud",
           .type = kInteger,
           .description = "Speed of the serial port",
           .by_default = "115200",
           .minimum = 50,
           .maximum = 10'000'000},
          {.name = "command",
           .type = kText,
           .description = "Command of the shell that prints the lines; it is ended with the "
                          "recording"},
          {.name = "tcp", .type = kText, .description = "HOST:PORT that sends the lines"},
          {.name = "pipe",
           .type = kText,
           .description = "Named pipe, file or character device that holds the lines"},
          {.name = "columns",
           .type = kText,
           .description = "What the columns are: time[ms],counter,gyro_x[deg/s],- for instance; - "
                          "is not recorded (default: the header that is printed)"},
          {.name = "rate",
           .type = kNumber,
           .description = "Rows a second (default: measured, to three digits)",
           .unit = "Hz",
           .minimum = 0.001,
           .maximum = 100'000.0},
          {.name = "listen",
           .type = kNumber,
           .description = "Time to listen at the start, to learn columns and rate",
           .unit = "s",
           .by_default = "2",
           .minimum = 0.1,
           .maximum = 60.0},
          {.name = "prefix",
           .type = kText,
           .description = "Text with which rows begin, such as IMU:; other lines are passed over",
           .by_default = ""},
          {.name = "checksum",
           .type = kText,
           .description = "Rows end in *hh, an NMEA 0183 checksum: damaged rows are refused",
           .by_default = "none",
           .choices = {"none", "nmea"}},
          {.name = "counter_maximum",
           .type = kInteger,
           .description = "Last value of the column counter before it is 0 again",
           .by_default = "4294967295",
           .minimum = 1},
          {.name = "time_maximum",
           .type = kNumber,
           .description = "Last value of the column time before it is 0 again, such as 4294967295 "
                          "of an Arduino's micros() (default: it goes on)",
           .minimum = 1.0},
      },
  };
}

SourcePlace place_of(const plugin::Options& options) {
  std::vector<SourcePlace> named;
  if (options.has("port"))
    named.push_back(
        serial_source(options.text("port"), static_cast<std::uint32_t>(options.integer("baud"))));
  if (options.has("command")) named.push_back(command_source(options.text("command")));
  if (options.has("tcp")) named.push_back(tcp_source(options.text("tcp")));
  if (options.has("pipe")) named.push_back(file_source(options.text("pipe")));
  if (named.size() != 1)
    throw plugin::DeviceError(IMUNOISE_BAD_OPTION,
                              "text: name one source: port=, command=, tcp= or pipe=");
  return named.front();
}

std::unique_ptr<plugin::Device> open_device(const plugin::Options& options,
                                            const plugin::Host& host) {
  Settings settings;
  settings.place = place_of(options);
  if (options.has("columns")) settings.columns = options.text("columns");
  settings.form.prefix = options.text("prefix");
  settings.form.checksum = options.text("checksum") == "nmea";
  if (options.has("time_maximum")) settings.form.time_maximum = options.number("time_maximum");
  if (options.has("rate")) settings.rate_hz = options.number("rate");
  settings.listen = std::chrono::milliseconds(std::llround(options.number("listen") * 1e3));
  settings.counter_maximum = static_cast<std::uint64_t>(options.integer("counter_maximum"));
  return std::make_unique<TextDevice>(std::move(settings), host);
}

}  // namespace
}  // namespace imunoise::text

IMUNOISE_DRIVER(imunoise::text::describe_driver, imunoise::text::open_device)
