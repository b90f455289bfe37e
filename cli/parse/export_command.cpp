#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "cli/parse/commands.h"
#include "cli/parse/raw_analysis.h"
#include "study/export/known_consumers.h"

namespace imunoise::cli {
namespace {

constexpr const char* kExportExamples = R"help(
Examples:
  imunoise export imu.csv --unit 'gyro_*=deg/s,acc_*=g' --to kalibr --out imu.yaml
  imunoise export recordings/monday --to px4 --device 0042
  imunoise calibrate imu.csv --json > imu.json
  imunoise export imu.json --to openvins --conservative --horizon 0.1..10

FILES are recordings, which are fitted first; or JSON files of imunoise calibrate or fit, or one of array; or the
folder of one recording, whose calibration.json is used if there is one.

Each file states its source with its SHA-256, the model of each axis, the formula and the unit of each value, and what
the program cannot express.)help";

std::string consumer_list() {
  std::string out = "\nPrograms:\n";
  for (const study::Consumer* const one : study::known_consumers())
    out += fmt::format("  {:<12} {}: {}\n", one->name, one->title, one->holds);
  return out;
}

std::vector<std::string> consumer_choices() {
  std::vector<std::string> out;
  for (const study::Consumer* const one : study::known_consumers()) out.emplace_back(one->name);
  return out;
}

study::AxisRule axis_rule_from(const std::string& text) {
  if (text == "each") return study::AxisRule::kEach;
  return text == "mean" ? study::AxisRule::kMean : study::AxisRule::kWorst;
}

study::Horizon horizon_from(const std::string& text) {
  study::Horizon out;
  const std::size_t dots = text.find("..");
  if (dots == std::string::npos || !CLI::detail::lexical_cast(text.substr(0, dots), out.begin) ||
      !CLI::detail::lexical_cast(text.substr(dots + 2), out.end) || !(out.begin > 0.0) ||
      !(out.begin <= out.end) || !std::isfinite(out.end))
    refuse("--horizon", "'" + text + "' is not a range of times (s), such as 0.1..10");
  return out;
}

// As it was typed.
struct RawExport {
  RawAnalysis analysis;
  ExportArguments arguments;
  std::string axes;
  std::string horizon = "0.1..10";
  double step = 0.0;
  std::string out;
};

void add_values(CLI::App& command, RawExport& raw) {
  command
      .add_option("--axis", raw.axes,
                  "Axes: a value for each, the worst, or the root mean square for all")
      ->check(CLI::IsMember({"each", "worst", "mean"}))
      ->default_str("each where the program has a value for each axis, else worst");
  command.add_flag("--conservative", raw.arguments.options.conservative,
                   "Bound the integrated error of the whole model over the horizon with white "
                   "noise and a random walk");
  command
      .add_option("--horizon", raw.horizon,
                  "Times over which the filter relies on the sensor alone (s)")
      ->type_name("SPAN")
      ->capture_default_str();
  command.add_option("--step", raw.step, "Step of the filter (s), for px4 and ardupilot")
      ->type_name("SECONDS")
      ->check(above_zero())
      ->default_str("the program's");
}

ParsedCommand export_command(CLI::App& program) {
  CLI::App* const command = program.add_subcommand(
      "export", "Write noise values in the form of Kalibr, PX4 and other programs, or as matrices");
  command->footer(kExportExamples + consumer_list());
  const auto raw = std::make_shared<RawExport>();
  add_input(*command, raw->analysis.input);
  by_default_of_inertia(*command);
  command->add_option("--to", raw->arguments.to, "Program to write for")
      ->type_name("PROGRAM")
      ->check(CLI::IsMember(consumer_choices()))
      ->required();
  command->add_option("--out", raw->out, "File to write")
      ->type_name("FILE")
      ->default_str("standard output");
  command
      ->add_option("--model", raw->arguments.models,
                   "Model to fit to recordings; give several to choose the best for each channel")
      ->type_name("MODEL")
      ->default_str("the best of many")
      ->allow_extra_args(false);
  command->add_option("--device", raw->arguments.device, "Name of the device in a recording")
      ->type_name("NAME")
      ->default_str("the only one");
  add_values(*command, *raw);
  return {command, [raw] {
            ExportArguments out = raw->arguments;
            out.input = input_from(raw->analysis.input);
            if (!raw->axes.empty()) out.options.axes = axis_rule_from(raw->axes);
            out.options.horizon = horizon_from(raw->horizon);
            if (raw->step > 0.0) out.options.step = raw->step;
            out.out = output_from("--out", raw->out, raw->analysis);
            return out;
          }};
}

}  // namespace

std::vector<ParsedCommand> export_commands(CLI::App& program) { return {export_command(program)}; }

}  // namespace imunoise::cli
