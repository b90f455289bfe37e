#include <memory>

#include "cli/parse/commands.h"
#include "drivers/adis16405/codec/registers.h"

namespace imunoise::cli {
namespace {

constexpr const char* kDriversHelp = R"help(
Examples:
  imunoise drivers                                       drivers with all their options
  imunoise drivers --driver-path ./build/lib             also drivers in this folder

imunoise looks for files imunoise-NAME.so in the folders of --driver-path, then in those of the environment
variable IMUNOISE_DRIVER_PATH (separated by ':'), then in lib/imunoise/drivers of the installation. If two
drivers have the same name, the first is used.)help";

constexpr const char* kDecodeExamples = R"help(
Examples:
  imunoise decode --format xbus capture.bin              one JSON line per sample
  imunoise decode --format candump bus.log --dbc imu.dbc
  candump -L can0 | imunoise decode --format candump --preset mti600 -
  imunoise decode --format adis16405 --sens-avg 0x0204 bursts.bin --json

imunoise reports rejected messages on standard error; with --json also in the last line.)help";

ParsedCommand drivers_command(CLI::App& program) {
  CLI::App* const drivers = program.add_subcommand(
      "drivers", "List drivers with their options, and drivers that cannot be loaded");
  drivers->footer(kDriversHelp);
  const auto folders = std::make_shared<std::vector<std::string>>();
  const auto json = std::make_shared<bool>(false);
  const auto names_only = std::make_shared<bool>(false);
  drivers->add_option("--driver-path", *folders, "Folder to search for drivers first")
      ->check(CLI::ExistingDirectory)
      ->type_name("FOLDER");
  auto* const names =
      drivers->add_flag("--names", *names_only, "Print only the names, one per line");
  drivers->add_flag("--json", *json, "Print the result as JSON")->excludes(names);
  return {drivers, [folders, json, names_only] {
            return DriversArguments{{folders->begin(), folders->end()}, *json, *names_only};
          }};
}

ParsedCommand decode_command(CLI::App& program) {
  struct Raw {
    DecodeArguments arguments;
    std::string format;
    std::string dbc;
  };
  CLI::App* const decode =
      program.add_subcommand("decode", "Decode the captured bytes of a device into samples");
  decode->footer(kDecodeExamples);
  const auto raw = std::make_shared<Raw>();
  DecodeArguments& capture = raw->arguments;
  decode->add_option("--format", raw->format, "Format of the capture")
      ->required()
      ->check(CLI::IsMember(drivers::wire_format_names()));
  decode->add_option("FILE", capture.file, "Capture to decode; - reads standard input")->required();
  auto* const database =
      decode->add_option("--dbc", raw->dbc, "candump: DBC file that describes the messages")
          ->type_name("FILE")
          ->check(CLI::ExistingFile);
  decode->add_option("--preset", capture.preset, "candump: known IMU: mti600, aceinna or mm5.10")
      ->type_name("IMU")
      ->excludes(database);
  capture.sens_avg = drivers::adis16405::kDefaultSensitivityAveraging;
  capture.smpl_prd = drivers::adis16405::kDefaultSamplePeriod;
  decode->add_option("--sens-avg", capture.sens_avg, "adis16405: value of register SENS_AVG")
      ->type_name("NUMBER")
      ->default_str("0x0402, 300 deg/s");
  decode->add_option("--smpl-prd", capture.smpl_prd, "adis16405: value of register SMPL_PRD")
      ->type_name("NUMBER")
      ->default_str("0x0001, 819.2 Hz");
  decode->add_flag("--json", capture.json, "Print the summary as the last JSON line");
  return {decode, [raw] {
            DecodeArguments out = raw->arguments;
            out.format =
                drivers::find_wire_format(raw->format).value();  // a member, says its check
            if (!raw->dbc.empty()) out.dbc = raw->dbc;
            return out;
          }};
}

}  // namespace

std::vector<ParsedCommand> device_commands(CLI::App& program) {
  return {drivers_command(program), decode_command(program)};
}

}  // namespace imunoise::cli
