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

The device that is replayed is recorded into FOLDER. To record it together with others use imunoise record
and the drivers replay and wire.)help";

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
      program.add_subcommand("replay", "Record what was recorded before, from its file or bytes");
  replay->footer(kReplayExamples);
  const auto raw = std::make_shared<Raw>();
  replay->add_option("SOURCE", raw->files, "A recording's folder, files of others, or a capture")
      ->required()
      ->check(CLI::ExistingPath);
  replay->add_option("--into", raw->into, "The new recording's folder; made when missing")
      ->required()
      ->type_name("FOLDER");
  replay->add_option("--speed", raw->speed, "Times real time; 0: as fast as possible")
      ->check(zero_or_above())
      ->capture_default_str();
  replay->add_option("--device", raw->one["device"], "Of a recording: which device");
  replay->add_option("--replicate", raw->one["replicate"], "Of a recording: which replicate");
  replay->add_option("--channel", raw->channels, "Of files and candump: a channel; repeatable")
      ->allow_extra_args(false);
  replay->add_option("--rate", raw->one["rate"], "Sampling rate in Hz, where SOURCE does not say");
  replay->add_option("--unit", raw->one["unit"], "Of files: unit of the channels");
  replay
      ->add_option("--format", raw->one["format"], "SOURCE is a capture: xbus, candump, adis16405")
      ->check(CLI::IsMember({"xbus", "candump", "adis16405"}));
  replay->add_option("--preset", raw->one["preset"], "candump: a known IMU");
  replay->add_option("--dbc", raw->one["dbc"], "candump: what the messages mean");
  replay
      ->add_option("--duration", raw->duration, "s of this computer's time; without it, to the end")
      ->check(above_zero());
  replay->add_flag("--json", raw->json, "Print the result as JSON");
  return {{replay, [raw] { return arguments_of(*raw); }}};
}

}  // namespace imunoise::cli
