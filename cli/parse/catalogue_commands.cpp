#include <memory>

#include "cli/parse/commands.h"
#include "cli/parse/daemon_options.h"
#include "cli/parse/raw_analysis.h"
#include "recording/import/pieces.h"
#include "study/analysis/arrays/array_series.h"

namespace imunoise::cli {
namespace {

constexpr const char* kCalibrateExamples = R"help(
Examples:
  imunoise calibrate recordings/monday                   all angular rates and accelerations, best models
  imunoise calibrate recordings/monday --model "WN + AR1 + RW" --report monday.html
  imunoise calibrate recordings/monday --channel gyro_x --no-diagnose
  imunoise calibrate imu.csv --unit 'gyro_*=deg/s' --report imu.html

The result of a recording is also written into the recording's folder, as calibration.json. If a channel cannot be
calibrated, the report says why, and the other channels are calibrated.)help";

constexpr const char* kRecordingsExamples = R"help(
Examples:
  imunoise recordings bench                              recordings in the folder bench
  imunoise recordings                                    recordings of the running imunoised
  imunoise recordings bench --catalogue "postgresql://host=db dbname=imunoise" --bench north)help";

constexpr const char* kCalibrationsExamples = R"help(
Examples:
  imunoise calibrations bench
  imunoise calibrations bench --json > calibrations.json)help";

constexpr const char* kHistoryExamples = R"help(
Examples:
  imunoise history bench --device 0042                   all calibrations of this device
  imunoise history bench --device imu0 --parameter N --report imu0.html
  imunoise history bench --device 0042 --channel gyro_x --parameter AR1.T

The test compares the newest calibration with all earlier ones. The exit status is 1 if they differ.)help";

ParsedCommand calibrate_command(CLI::App& program) {
  CLI::App* const calibrate = program.add_subcommand(
      "calibrate", "Calibrate one recording or files: fit, test and diagnose all channels");
  calibrate->footer(kCalibrateExamples);
  const auto raw = std::make_shared<RawAnalysis>();
  const auto options = std::make_shared<study::CalibrateOptions>();
  add_input(*calibrate, raw->input);
  by_default_of_inertia(*calibrate);
  const auto array_model = std::make_shared<std::string>();
  calibrate
      ->add_option("--model", options->models,
                   "Model to fit; give several to choose the best for each channel by "
                   "cross-validation")
      ->type_name("MODEL")
      ->default_str("the best of many")
      ->allow_extra_args(false);
  calibrate->add_flag("!--no-diagnose", options->diagnose, "Skip the search for missing effects");
  calibrate->add_flag("--array", options->array,
                      "Analyse the channels of one quantity as an array, and channels of the same "
                      "name across devices, too");
  calibrate->add_option("--array-model", *array_model, "Model of the array")
      ->type_name("MODEL")
      ->default_str(std::string(study::kDefaultArrayModel));
  calibrate
      ->add_option("--bootstrap", options->bootstrap.sets,
                   "Number of bootstrap sets for the test between replicates; 0 disables it")
      ->type_name("COUNT")
      ->check(CLI::Range(0, 1'000'000))
      ->capture_default_str();
  calibrate->add_option("--seed", options->bootstrap.seed, "Random seed of the bootstrap")
      ->type_name("SEED")
      ->capture_default_str();
  add_json(*calibrate, *raw);
  add_report(*calibrate, *raw);
  return {calibrate, [raw, options, array_model] {
            CalibrateArguments out{input_from(raw->input), *options, show_from(*raw)};
            out.calibrate.channels = out.input.import.channels;
            const std::filesystem::path& first = out.input.files.front();
            const bool folder =
                std::filesystem::is_directory(first) && recording::pieces_of(first).empty();
            if (folder && (out.input.files.size() > 1 || out.input.import.rate ||
                           !out.input.import.units.empty() || out.input.import.split_into > 1))
              refuse("FILES",
                     "one folder of a recording, or files; --rate, --unit and --split-into "
                     "are for files");
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
      command.add_option("FOLDER", raw.folder, "Folder with recordings, at any depth")
          ->default_str("the recordings of imunoised")
          ->check(CLI::ExistingDirectory);
  command
      .add_option("--catalogue", raw.catalogue,
                  "Database of the catalogue: a SQLite file or postgresql://...")
      ->type_name("DATABASE")
      ->default_str("FOLDER/catalogue.sqlite")
      ->needs(folder);
  command.add_option("--bench", raw.bench, "Name of this folder in a catalogue of several folders")
      ->type_name("NAME")
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
  CLI::App* const history = program.add_subcommand(
      "history",
      "Show how the noise of a device changes over months, and test the newest calibration");
  history->footer(kHistoryExamples);
  const auto raw = std::make_shared<RawCatalogue>();
  const auto device = std::make_shared<std::string>();
  const auto options = std::make_shared<catalogue::HistoryOptions>();
  add_catalogue(*history, *raw);
  history
      ->add_option("--device", *device, "Serial number of the device, its name, or driver:serial")
      ->type_name("NAME")
      ->required();
  history
      ->add_option("--parameter", options->parameters,
                   "Parameter to show: N, B, K, R, Q, sigma, T, f, zeta, AR1.T or a title")
      ->type_name("NAME")
      ->default_str("all")
      ->allow_extra_args(false);
  history
      ->add_option("--channel", options->channels,
                   "Names of the channels to show, separated by commas")
      ->type_name("NAMES")
      ->default_str("all")
      ->delimiter(',');
  history
      ->add_option("--level", options->level,
                   "False-alarm probability at each new calibration, over all parameters shown")
      ->type_name("PROBABILITY")
      ->check(CLI::Range(1e-9, 0.5))
      ->capture_default_str();
  return {history, [raw, device, options] {
            return HistoryArguments{catalogue_from(*raw), *device, *options};
          }};
}

}  // namespace

std::vector<ParsedCommand> catalogue_commands(CLI::App& program) {
  return {
      calibrate_command(program),
      list_command<RecordingsArguments>(program, "recordings",
                                        "List the recordings in a folder, or of imunoised",
                                        kRecordingsExamples),
      list_command<CalibrationsArguments>(
          program, "calibrations", "List the calibrations of recordings", kCalibrationsExamples),
      history_command(program)};
}

}  // namespace imunoise::cli
