#include <memory>

#include "cli/parse/commands.h"
#include "cli/parse/raw_analysis.h"

namespace imunoise::cli {
namespace {

constexpr const char* kDatasheetExamples = R"help(
Examples:
  imunoise datasheet imu.csv --unit 'gyro_*=deg/s' --gyro "N=0.3 deg/sqrt(h), B=5 deg/h"
  imunoise datasheet run?.h5 --accelerometer "N=60 ug/sqrt(Hz), B=15 ug" --report sheet.html
  imunoise datasheet --gyro "N=0.007 dps/sqrt(Hz), B=2 deg/h" --rate 200    the model alone

N (ARW, VRW), B and K (RRW) are taken in any unit that data sheets print: deg/√h, dps/√Hz, (deg/h)/√Hz, m/s/√h, ug/√Hz,
(deg/h)/√h, ...)help";

void add_figures(CLI::App& command, std::string& to, const char* name, const char* about) {
  command.add_option(name, to, about)->type_name("FIGURES");
}

std::optional<study::PrintedFigures> figures_from(const std::string& option,
                                                  const std::string& text, Quantity quantity) {
  if (text.empty()) return std::nullopt;
  auto out = study::parse_printed(text, quantity);
  if (!out) refuse(option, out.error().message);
  return *out;
}

ParsedCommand datasheet_command(CLI::App& program) {
  CLI::App* const command =
      program.add_subcommand("datasheet", "Compare the figures of a data sheet with a measurement");
  command->footer(kDatasheetExamples);
  const auto raw = std::make_shared<RawAnalysis>();
  const auto gyro = std::make_shared<std::string>();
  const auto accelerometer = std::make_shared<std::string>();
  const auto svg = std::make_shared<std::string>();
  add_input(*command, raw->input);
  command->get_option("FILES")->required(false);
  add_figures(*command, *gyro, "--gyro", "Printed figures of the gyro: N, B, K with their units");
  add_figures(*command, *accelerometer, "--accelerometer",
              "Printed figures of the accelerometer: N, B, K with their units");
  add_confidence(*command, *raw);
  add_json(*command, *raw);
  add_report(*command, *raw);
  command->add_option("--svg", *svg, "SVG picture of each channel to write")->type_name("OUT.svg");
  return {command, [raw, gyro, accelerometer, svg] {
            DatasheetArguments out;
            out.input = input_from(raw->input);
            out.gyro = figures_from("--gyro", *gyro, Quantity::kAngularRate);
            out.accelerometer =
                figures_from("--accelerometer", *accelerometer, Quantity::kAcceleration);
            if (!out.gyro && !out.accelerometer)
              refuse("--gyro", "name the printed figures, or those of --accelerometer");
            if (out.input.files.empty() && !out.input.import.rate)
              refuse("--rate", "needed where there is no measurement");
            out.confidence = raw->confidence;
            out.show = show_from(*raw);
            out.svg = output_from("--svg", *svg, *raw);
            return out;
          }};
}

}  // namespace

std::vector<ParsedCommand> datasheet_commands(CLI::App& program) {
  return {datasheet_command(program)};
}

}  // namespace imunoise::cli
