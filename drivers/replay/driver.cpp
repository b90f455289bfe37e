// The driver "replay": recorded files as a device.

#include <fmt/format.h>

#include <filesystem>
#include <initializer_list>
#include <memory>
#include <utility>

#include "drivers/plugin.h"
#include "drivers/plugin/or_throw.h"
#include "drivers/replay/recording_device.h"
#include "drivers/replay/replay_device.h"
#include "recording/import/import.h"

namespace imunoise::replay {
namespace {

drivers::DriverInfo describe_driver() {
  using enum drivers::OptionType;
  return {
      "replay",
      "Recordings as a device: those of imunoise, and files in HDF5, CSV, NumPy, raw numbers",
      IMUNOISE_VERSION,
      {
          {.name = "file",
           .type = kText,
           .description =
               "A recording's folder, or a file; several files are replicates, one after "
               "another",
           .required = true,
           .repeated = true},
          speed_option(),
          {.name = "latency",
           .type = kNumber,
           .description = "Interval between groups of samples, as over USB; 0 sends single samples",
           .unit = "s",
           .by_default = "0.05",
           .minimum = 0.0,
           .maximum = 10.0},
          {.name = "device",
           .type = kText,
           .description = "Device to replay from a recording (default: the only one)"},
          {.name = "replicate",
           .type = kInteger,
           .description = "Replicate to replay from a recording (default: the first)",
           .minimum = 1,
           .maximum = 1000000},
          {.name = "channel",
           .type = kText,
           .description = "Channel to replay from files (default: all)",
           .repeated = true},
          {.name = "rate",
           .type = kNumber,
           .description = "Sampling rate of a file that does not state it",
           .unit = "Hz",
           .minimum = 0.0},
          {.name = "unit",
           .type = kText,
           .description = "Unit of the channels, such as deg/s; overrides the file's"},
          {.name = "split_into",
           .type = kInteger,
           .description = "Number of equal replicates to cut each file into",
           .by_default = "1",
           .minimum = 1.0,
           .maximum = 100000.0},
      },
  };
}

Pace pace_of(const plugin::Options& options) {
  return {options.number("speed"), options.number("latency")};
}

// Options that say nothing where they were given.
void refuse_if_given(const plugin::Options& options, std::initializer_list<const char*> names,
                     const char* why) {
  for (const char* const name : names) {
    if (!options.has(name)) continue;
    throw plugin::DeviceError(IMUNOISE_BAD_OPTION, fmt::format("{}: {}", name, why));
  }
}

std::unique_ptr<plugin::Device> open_recording(const std::string& folder,
                                               const plugin::Options& options,
                                               const plugin::Host& host) {
  refuse_if_given(options, {"channel", "rate", "unit"},
                  "a recording of imunoise is replayed as it is");
  RecordingChoice choice{folder};
  if (options.has("device")) choice.device = options.text("device");
  if (options.has("replicate")) {
    choice.replicate = static_cast<std::uint32_t>(options.integer("replicate"));
  }
  return std::make_unique<RecordingDevice>(plugin::or_throw(read_recording(choice)),
                                           pace_of(options), host);
}

std::unique_ptr<plugin::Device> open_files(const std::vector<std::string>& names,
                                           const plugin::Options& options,
                                           const plugin::Host& host) {
  refuse_if_given(options, {"device", "replicate"}, "only recordings of imunoise have several");
  recording::ImportOptions import;
  import.channels = options.texts("channel");
  if (options.has("rate")) import.rate = Hertz{options.number("rate")};
  if (options.has("unit"))
    import.units = {{ "*", plugin::or_throw(parse_unit(options.text("unit"))) }};
  import.split_into = static_cast<std::size_t>(options.integer("split_into"));
  const std::vector<std::filesystem::path> files(names.begin(), names.end());
  const Progress until({}, host.opening().token());
  return std::make_unique<ReplayDevice>(
      plugin::or_throw(recording::import_files(files, import, until)), pace_of(options), host);
}

std::unique_ptr<plugin::Device> open_device(const plugin::Options& options,
                                            const plugin::Host& host) {
  const std::vector<std::string> names = options.texts("file");
  if (names.size() == 1 && std::filesystem::is_directory(names.front())) {
    return open_recording(names.front(), options, host);
  }
  return open_files(names, options, host);
}

}  // namespace
}  // namespace imunoise::replay

IMUNOISE_DRIVER(imunoise::replay::describe_driver, imunoise::replay::open_device)
