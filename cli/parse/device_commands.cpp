#include <memory>

#include "cli/parse/commands.h"
#include "drivers/adis16405/registers.h"

namespace imunoise::cli {
namespace {

constexpr const char* kDriversHelp = R"help(
Drivers are files imunoise-NAME.so in the folders given here, in those of the environment variable
IMUNOISE_DRIVER_PATH (separated by ':'), and in lib/imunoise/drivers of the installation. The first of
a name wins.)help";

constexpr const char* kDecodeExamples = R"help(
Examples:
  imunoise decode --format xbus capture.bin              one JSON line a sample
  imunoise decode --format candump bus.log --dbc imu.dbc
  candump -L can0 | imunoise decode --format candump --preset mti600 -
  imunoise decode --format adis16405 --sens-avg 0x0204 bursts.bin --json

What was refused, and why, goes to standard error; with --json it is the last line.)help";

CaptureFormat format_from(const std::string& name) {
  if (name == "xbus") return CaptureFormat::kXbus;
  return name == "candump" ? CaptureFormat::kCandump : CaptureFormat::kAdis16405;
}

ParsedCommand drivers_command(CLI::App& program) {
  CLI::App* const drivers =
      program.add_subcommand("drivers", "List drivers of devices, and why any was refused");
  drivers->footer(kDriversHelp);
  const auto folders = std::make_shared<std::vector<std::string>>();
  const auto json = std::make_shared<bool>(false);
  drivers->add_option("--driver-path", *folders, "A folder to search before the others; repeatable")
      ->check(CLI::ExistingDirectory)
      ->type_name("FOLDER");
  drivers->add_flag("--json", *json, "Print the result as JSON");
  return {drivers, [folders, json] {
            return DriversArguments{{folders->begin(), folders->end()}, *json};
          }};
}

ParsedCommand decode_command(CLI::App& program) {
  struct Raw {
    DecodeArguments arguments;
    std::string format;
    std::string dbc;
  };
  CLI::App* const decode =
      program.add_subcommand("decode", "Print the samples in a device's bytes");
  decode->footer(kDecodeExamples);
  const auto raw = std::make_shared<Raw>();
  DecodeArguments& capture = raw->arguments;
  decode->add_option("--format", raw->format, "How the bytes are to be read")
      ->required()
      ->check(CLI::IsMember({"xbus", "candump", "adis16405"}));
  decode->add_option("FILE", capture.file, "The capture; - is standard input")->required();
  auto* const database = decode->add_option("--dbc", raw->dbc, "candump: what the messages mean")
                             ->check(CLI::ExistingFile);
  decode->add_option("--preset", capture.preset, "candump: a known IMU: mti600, aceinna, mm5.10")
      ->excludes(database);
  capture.sens_avg = drivers::adis16405::kDefaultSensitivityAveraging;
  capture.smpl_prd = drivers::adis16405::kDefaultSamplePeriod;
  decode->add_option("--sens-avg", capture.sens_avg,
                     "adis16405: register SENS_AVG (default: 0x0402, 300 deg/s)");
  decode->add_option("--smpl-prd", capture.smpl_prd,
                     "adis16405: register SMPL_PRD (default: 0x0001, 819.2 Hz)");
  decode->add_flag("--json", capture.json, "Print the summary as the last JSON line");
  return {decode, [raw] {
            DecodeArguments out = raw->arguments;
            out.format = format_from(raw->format);
            if (!raw->dbc.empty()) out.dbc = raw->dbc;
            return out;
          }};
}

}  // namespace

std::vector<ParsedCommand> device_commands(CLI::App& program) {
  return {drivers_command(program), decode_command(program)};
}

}  // namespace imunoise::cli
