// The driver "replay": recorded files as a device.

#include <memory>
#include <utility>

#include "drivers/plugin.h"
#include "drivers/replay/replay_device.h"
#include "recording/import/import.h"

namespace imunoise::replay {
namespace {

drivers::DriverInfo describe_driver() {
  using enum drivers::OptionType;
  return {
      "replay",
      "Recorded files as a device: HDF5, CSV, NumPy, raw numbers",
      IMUNOISE_VERSION,
      {
          {.name = "file",
           .type = kText,
           .description = "A file to replay; several are replicates, one after another",
           .required = true,
           .repeated = true},
          {.name = "speed",
           .type = kNumber,
           .description = "Times real time; 0: as fast as it is read",
           .by_default = "1",
           .minimum = 0.0,
           .maximum = 1e9},
          {.name = "latency",
           .type = kNumber,
           .description = "Samples come in groups, this often, as over USB; 0: one by one",
           .unit = "s",
           .by_default = "0.01",
           .minimum = 0.0,
           .maximum = 10.0},
          {.name = "channel",
           .type = kText,
           .description = "A channel to replay, by name (default: all)",
           .repeated = true},
          {.name = "rate",
           .type = kNumber,
           .description = "Sampling rate, where the file does not say",
           .unit = "Hz",
           .minimum = 0.0},
          {.name = "unit",
           .type = kText,
           .description = "Unit of the channels, as deg/s; wins over what the file says"},
          {.name = "split_into",
           .type = kInteger,
           .description = "Replicates of equal length to cut each file into",
           .by_default = "1",
           .minimum = 1.0,
           .maximum = 100000.0},
      },
  };
}

template <class T>
T or_throw(Result<T> result) {
  if (!result) throw plugin::DeviceError(IMUNOISE_BAD_OPTION, result.error().message);
  return std::move(*result);
}

std::unique_ptr<plugin::Device> open_device(const plugin::Options& options,
                                            const plugin::Host& host) {
  recording::ImportOptions import;
  import.channels = options.texts("channel");
  if (options.has("rate")) import.rate = Hertz{options.number("rate")};
  if (options.has("unit")) import.unit = or_throw(parse_unit(options.text("unit")));
  import.split_into = static_cast<std::size_t>(options.integer("split_into"));
  const std::vector<std::string> names = options.texts("file");
  const std::vector<std::filesystem::path> files(names.begin(), names.end());
  return std::make_unique<ReplayDevice>(or_throw(recording::import_files(files, import)),
                                        Pace{options.number("speed"), options.number("latency")},
                                        host);
}

}  // namespace
}  // namespace imunoise::replay

IMUNOISE_DRIVER(imunoise::replay::describe_driver, imunoise::replay::open_device)
