#include <fmt/format.h>

#include <memory>

#include "cli/parse/commands.h"
#include "cli/parse/daemon_options.h"
#include "cli/parse/raw_analysis.h"
#include "study/analysis/array_series.h"

namespace imunoise::cli {
namespace {

constexpr const char* kCalibrateExamples = R"help(
Examples:
  imunoise calibrate recordings/monday                   every rate and acceleration, models chosen
  imunoise calibrate recordings/monday --model "WN + AR1 + RW" --report monday.html
  imunoise calibrate recordings/monday --channel gyro_x --no-diagnose

FOLDER is one recording (imunoise record). The result is also written into it, as calibration.json; a
channel that cannot be calibrated says why and does not stop the others.)help";

constexpr const char* kRecordingsExamples = R"help(
Examples:
  imunoise recordings bench                              what lies in the folder bench
  imunoise recordings                                    what imunoised has recorded
  imunoise recordings bench --catalogue "postgresql://host=db dbname=imunoise" --bench north)help";

constexpr const char* kCalibrationsExamples = R"help(
Examples:
  imunoise calibrations bench
  imunoise calibrations bench --json > calibrations.json)help";

constexpr const char* kHistoryExamples = R"help(
Examples:
  imunoise history bench --device 0042                   everything that is known of this device
  imunoise history bench --device imu0 --parameter N --report imu0.html
  imunoise history bench --device 0042 --channel gyro_x --parameter AR1.T

Is the newest calibration compatible with those before it? The exit status is 1 when it is not.)help";

ParsedCommand calibrate_command(CLI::App& program) {
  CLI::App* const calibrate =
      program.add_subcommand("calibrate", "Everything about the noise of one recording");
  calibrate->footer(kCalibrateExamples);
  const auto raw = std::make_shared<RawAnalysis>();
  const auto folder = std::make_shared<std::string>();
  const auto options = std::make_shared<study::CalibrateOptions>();
  calibrate->add_option("FOLDER", *folder, "A recording's folder")
      ->required()
      ->check(CLI::ExistingDirectory);
  const auto array_model = std::make_shared<std::string>();
  calibrate
      ->add_option("--model", options->models,
                   "One: it is fitted; several: the best of them by cross-validation, for each "
                   "channel (default: the best of many)")
      ->allow_extra_args(false);
  calibrate
      ->add_option("--channel", options->channels,
                   "A channel; repeatable (default: all angular rates and accelerations)")
      ->delimiter(',');
  calibrate->add_flag("!--no-diagnose", options->diagnose, "Do not seek effects that are missing");
  calibrate->add_flag("--array", options->array,
                      "Channels of one quantity as an array, and those of one name in several "
                      "devices, too");
  calibrate->add_option("--array-model", *array_model,
                        fmt::format("Of the array (default: {})", study::kDefaultArrayModel));
  calibrate
      ->add_option("--bootstrap", options->bootstrap.sets,
                   "Sets of the bootstrap of the test between replicates; 0: none")
      ->check(CLI::Range(0, 1'000'000))
      ->capture_default_str();
  calibrate->add_option("--seed", options->bootstrap.seed, "Seed of the bootstrap")
      ->capture_default_str();
  add_json(*calibrate, *raw);
  add_report(*calibrate, *raw);
  return {calibrate, [raw, folder, options, array_model] {
            CalibrateArguments out{*folder, *options, show_from(*raw)};
            if (!array_model->empty()) out.calibrate.array_model = *array_model;
            return out;
          }};
}

// What the commands on a folder of recordings have in common.
struct RawCatalogue {
  RawAnalysis raw;
  std::string folder;
  std::string catalogue;
  std::string bench;
  RawDaemon daemon;
};

void add_catalogue(CLI::App& command, RawCatalogue& raw) {
  auto* const folder =
      command
          .add_option("FOLDER", raw.folder,
                      "A folder with recordings, at any depth (default: those of imunoised)")
          ->check(CLI::ExistingDirectory);
  command
      .add_option(
          "--catalogue", raw.catalogue,
          "The index: a SQLite file, or postgresql://... (default: FOLDER/catalogue.sqlite)")
      ->type_name("WHERE")
      ->needs(folder);
  command.add_option("--bench", raw.bench, "Name of this folder in a catalogue of several")
      ->needs(folder);
  add_daemon(command, raw.daemon);
  add_json(command, raw.raw);
  add_report(command, raw.raw);
}

CatalogueArguments catalogue_from(const RawCatalogue& raw) {
  CatalogueArguments out{raw.folder, std::nullopt, raw.bench, show_from(raw.raw),
                         daemon_from(raw.daemon)};
  if (!raw.catalogue.empty()) out.catalogue = raw.catalogue;
  return out;
}

template <class ListArguments>
ParsedCommand list_command(CLI::App& program, const char* name, const char* about,
                           const char* examples) {
  CLI::App* const command = program.add_subcommand(name, about);
  command->footer(examples);
  const auto raw = std::make_shared<RawCatalogue>();
  add_catalogue(*command, *raw);
  return {command, [raw] { return ListArguments{catalogue_from(*raw)}; }};
}

ParsedCommand history_command(CLI::App& program) {
  CLI::App* const history =
      program.add_subcommand("history", "A device's noise over months, with a drift alarm");
  history->footer(kHistoryExamples);
  const auto raw = std::make_shared<RawCatalogue>();
  const auto device = std::make_shared<std::string>();
  const auto options = std::make_shared<catalogue::HistoryOptions>();
  add_catalogue(*history, *raw);
  history->add_option("--device", *device, "Its serial number, its name, or driver:serial")
      ->required();
  history
      ->add_option("--parameter", options->parameters,
                   "N, B, K, R, Q, sigma, T, f, zeta, AR1.T or a title; repeatable (default: all)")
      ->allow_extra_args(false);
  history->add_option("--channel", options->channels, "A channel; repeatable (default: all)")
      ->delimiter(',');
  history
      ->add_option("--level", options->level,
                   "Chance of a false alarm at each new calibration, over all parameters shown")
      ->check(CLI::Range(1e-9, 0.5))
      ->capture_default_str();
  return {history, [raw, device, options] {
            return HistoryArguments{catalogue_from(*raw), *device, *options};
          }};
}

}  // namespace

std::vector<ParsedCommand> catalogue_commands(CLI::App& program) {
  return {calibrate_command(program),
          list_command<RecordingsArguments>(
              program, "recordings", "The recordings in a folder of them", kRecordingsExamples),
          list_command<CalibrationsArguments>(program, "calibrations",
                                              "The calibrations of the recordings in a folder",
                                              kCalibrationsExamples),
          history_command(program)};
}

}  // namespace imunoise::cli
