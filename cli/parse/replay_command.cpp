#include <fmt/format.h>

#include <map>
#include <memory>

#include "cli/parse/commands.h"
#include "cli/parse/input_options.h"

namespace imunoise::cli {
namespace {

constexpr const char* kReplayExamples = R"help(
Examples:
  imunoise replay recordings/monday --into copy                     as fast as possible
  imunoise replay recordings/monday --device xsens --speed 1 --into copy
  imunoise replay run1.h5 --rate 100 --into copy
  imunoise replay monday/replicate-1/xsens.wire --format xbus --into again
  imunoise replay bus.log --format candump --preset mti600 --into again

To replay a device together with other devices, use imunoise record with the drivers replay and wire.)help";

struct Raw {
  std::vector<std::string> files;
  std::string into;
  double speed = 0.0;
  double duration = 0.0;
  bool json = false;
  // Options of the drivers, by their names there; empty: not given.
  std::map<std::string, std::string> one;
  std::vector<std::string> channels;
};

RecordArguments arguments_of(const Raw& raw) {
  const bool wire = !raw.one.at("format").empty();
  DeviceArguments device{wire ? "wire" : "replay", {fmt::format("speed={}", raw.speed)}};
  for (const std::string& file : raw.files) device.options.push_back("file=" + file);
  for (const auto& [name, value] : raw.one) {
    if (!value.empty()) device.options.push_back(name + "=" + value);
  }
  for (const std::string& channel : raw.channels) device.options.push_back("channel=" + channel);
  RecordArguments out;
  out.folder = raw.into;
  out.devices = {std::move(device)};
  if (raw.duration > 0.0) out.duration = std::chrono::duration<double>(raw.duration);
  out.json = raw.json;
  return out;
}

}  // namespace

std::vector<ParsedCommand> replay_commands(CLI::App& program) {
  CLI::App* const replay =
      program.add_subcommand("replay", "Record again from a recording, a file or captured bytes");
  replay->footer(kReplayExamples);
  const auto raw = std::make_shared<Raw>();
  replay->add_option("SOURCE", raw->files, "Folder of a recording, data files, or a capture")
      ->required()
      ->check(CLI::ExistingPath);
  replay->add_option("--into", raw->into, "Folder of the new recording; created if missing")
      ->required()
      ->type_name("FOLDER");
  replay->add_option("--speed", raw->speed, "Speed relative to real time; 0 is as fast as possible")
      ->type_name("FACTOR")
      ->check(zero_or_above())
      ->capture_default_str();
  replay
      ->add_option("--device", raw->one["device"], "Name of the device to replay from a recording")
      ->type_name("NAME")
      ->default_str("the only one");
  replay
      ->add_option("--replicate", raw->one["replicate"],
                   "Number of the replicate to replay from a recording")
      ->type_name("NUMBER")
      ->default_str("the first one");
  replay
      ->add_option("--channel", raw->channels, "Channel to replay from data files or a candump log")
      ->type_name("CHANNEL")
      ->default_str("all")
      ->allow_extra_args(false);
  replay
      ->add_option("--rate", raw->one["rate"],
                   "Sampling rate (Hz) of a source that does not state it")
      ->type_name("HZ");
  replay->add_option("--unit", raw->one["unit"], "Unit of the channels of data files")
      ->type_name("UNIT");
  replay->add_option("--format", raw->one["format"], "Format of SOURCE, if it is a capture")
      ->check(CLI::IsMember(drivers::wire_format_names()));
  replay
      ->add_option("--preset", raw->one["preset"], "candump: known IMU: mti600, aceinna or mm5.10")
      ->type_name("IMU");
  replay->add_option("--dbc", raw->one["dbc"], "candump: DBC file that describes the messages")
      ->type_name("FILE");
  replay->add_option("--duration", raw->duration, "Time to replay (s of this computer's clock)")
      ->type_name("SECONDS")
      ->default_str("to the end of the source")
      ->check(above_zero());
  replay->add_flag("--json", raw->json, "Print the result as JSON");
  return {{replay, [raw] { return arguments_of(*raw); }}};
}

}  // namespace imunoise::cli
