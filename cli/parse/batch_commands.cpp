#include <memory>

#include "cli/parse/commands.h"
#include "cli/parse/raw_analysis.h"
#include "study/batch/batch_plan.h"

namespace imunoise::cli {
namespace {

constexpr const char* kBatchExamples = R"help(
Examples:
  imunoise batch new nightly --calibrate recordings/* --model "WN + AR1 + RW"
  imunoise batch new trial --simulate "WN(sigma2=1e-6) + RW(gamma2=1e-14)" --rate 100 --samples 360000 \
      --replicates 6 --sets 1000 --seed 1
  imunoise batch run trial --workers 4                   on this machine
  imunoise batch run trial --engine slurm --workers 64 --sbatch=--partition=long
  imunoise batch status trial
  imunoise batch merge trial --report trial.html

A batch is a folder of shards. imunoise batch run computes the shards without a result, then merges all results.
Run it again after an interruption.)help";

constexpr const char* kBatchNewExamples = R"help(
Examples:
  imunoise batch new nightly --calibrate recordings/* --model "WN + AR1 + RW"
  imunoise batch new trial --simulate "WN(sigma2=1e-6) + RW(gamma2=1e-14)" --rate 100 --samples 360000 --sets 1000

Give either --calibrate or --simulate. --calibrate runs imunoise calibrate for each recording. --simulate
simulates sets of replicates and fits a model to each set; it shows what recordings of this length can tell.)help";

constexpr const char* kBatchRunExamples = R"help(
Examples:
  imunoise batch run trial --workers 4
  imunoise batch run trial --engine slurm --workers 64 --sbatch=--partition=long)help";

constexpr const char* kBatchShardExamples = R"help(
Examples:
  imunoise batch shard trial 17                          compute one shard in this process)help";

constexpr const char* kBatchStatusExamples = R"help(
Examples:
  imunoise batch status trial
  imunoise batch status trial --json)help";

constexpr const char* kBatchMergeExamples = R"help(
Examples:
  imunoise batch merge trial --report trial.html)help";

struct RawNew {
  RawAnalysis raw;
  std::string folder;
  std::vector<std::string> recordings;
  std::vector<std::string> models;
  v1::CalibrationSettings settings;
  v1::SimulationTask simulate;
  std::uint32_t shard_size = 0;
};

// An option that sets a field of a message.
template <class T, class Message>
CLI::Option* add_field(CLI::App& app, const std::string& option, Message& message,
                       void (Message::*set)(T), const char* about) {
  return app.add_option_function<T>(
      option, [&message, set](const T& value) { (message.*set)(value); }, about);
}

void add_calibration(CLI::App& part, RawNew& typed, CLI::Option_group& task) {
  task.add_option("--calibrate", typed.recordings, "Folders of the recordings to calibrate")
      ->check(CLI::ExistingDirectory)
      ->type_name("RECORDING");
  typed.settings.set_diagnose(true);
  typed.settings.set_seed(BootstrapOptions{}.seed);
  part.add_option_function<std::vector<std::string>>(
          "--channel",
          [&typed](const std::vector<std::string>& names) {
            typed.settings.mutable_channels()->Assign(names.begin(), names.end());
          },
          "Names of the channels to calibrate, separated by commas")
      ->type_name("NAMES")
      ->default_str("all angular rates and accelerations")
      ->delimiter(',')
      ->allow_extra_args(false);
  part.add_flag_callback(
      "--no-diagnose", [&typed] { typed.settings.set_diagnose(false); },
      "Skip the search for missing effects");
  part.add_flag_callback(
      "--array", [&typed] { typed.settings.set_array(true); },
      "Analyse the channels of one quantity as an array, too");
  add_field(part, "--bootstrap", typed.settings, &v1::CalibrationSettings::set_bootstrap_sets,
            "Number of bootstrap sets for the test between replicates")
      ->type_name("COUNT")
      ->check(CLI::Range(0, 1'000'000));
}

void add_simulation(CLI::App& part, RawNew& typed, CLI::Option_group& task) {
  v1::SimulationTask& to = typed.simulate;
  task.add_option_function<std::string>(
          "--simulate", [&to](const std::string& model) { to.set_model(model); },
          "Model to simulate, with all its values")
      ->type_name("MODEL");
  to.set_replicates(1);
  to.set_seed(1);
  add_field(part, "--rate", to, &v1::SimulationTask::set_rate_hz, "Sampling rate (Hz)")
      ->type_name("HZ")
      ->check(CLI::PositiveNumber);
  add_field(part, "--samples", to, &v1::SimulationTask::set_samples,
            "Number of samples per replicate")
      ->type_name("COUNT")
      ->check(CLI::Range(std::uint64_t{16}, std::uint64_t{1} << 32U));
  add_field(part, "--replicates", to, &v1::SimulationTask::set_replicates,
            "Number of replicates per set")
      ->type_name("COUNT")
      ->default_str("1")
      ->check(CLI::Range(1, 100'000));
  add_field(part, "--sets", to, &v1::SimulationTask::set_sets, "Number of sets to simulate")
      ->type_name("COUNT")
      ->check(CLI::Range(1, 100'000'000));
  part.add_option_function<std::uint64_t>(
          "--seed",
          [&typed](const std::uint64_t& seed) {
            typed.simulate.set_seed(seed);
            typed.settings.set_seed(seed);
          },
          "Random seed of the simulation, or of the bootstrap")
      ->type_name("SEED")
      ->default_str("1");
}

v1::Batch batch_from(const RawNew& typed) {
  v1::Batch out;
  out.set_version(study::kBatchVersion);
  if (!typed.recordings.empty()) {
    *out.mutable_calibrate()->mutable_settings() = typed.settings;
    for (const std::string& one : typed.models)
      out.mutable_calibrate()->mutable_settings()->add_models(one);
    for (const std::string& one : typed.recordings)
      out.mutable_calibrate()->add_recordings(std::filesystem::absolute(one).string());
  } else {
    v1::SimulationTask& task = *out.mutable_simulate();
    task = typed.simulate;
    if (task.rate_hz() == 0.0) refuse("--rate", "required by --simulate");
    if (task.samples() == 0) refuse("--samples", "required by --simulate");
    if (task.sets() == 0) refuse("--sets", "required by --simulate");
    task.set_confidence(typed.raw.confidence);
    const auto form = study::form_of(task.model(), task.rate_hz());
    if (!form) refuse("--simulate", form.error().message);
    if (typed.models.size() > 1) refuse("--model", "give only one with --simulate");
    task.set_fit(typed.models.empty() ? *form : typed.models.front());
  }
  out.set_shard_size(typed.shard_size > 0 ? typed.shard_size : study::default_shard_size(out));
  return out;
}

ParsedCommand new_command(CLI::App& batch) {
  CLI::App* const part = batch.add_subcommand("new", "Create a batch");
  part->footer(kBatchNewExamples);
  const auto typed = std::make_shared<RawNew>();
  part->add_option("FOLDER", typed->folder, "Folder of the new batch")->required();
  CLI::Option_group* const task = part->add_option_group("task", "Task");
  add_calibration(*part, *typed, *task);
  add_simulation(*part, *typed, *task);
  task->require_option(1);
  part->add_option("--model", typed->models,
                   "Model to fit; give several with --calibrate to choose the best of them")
      ->type_name("MODEL")
      ->default_str("the best of many; with --simulate the form of the true model")
      ->allow_extra_args(false);
  add_confidence(*part, typed->raw);
  part->add_option("--shard-size", typed->shard_size, "Number of recordings, or sets, per shard")
      ->type_name("COUNT")
      ->default_str("1 recording, or 1 % of the sets")
      ->check(CLI::Range(1, 100'000'000));
  return {part, [typed] { return BatchNewArguments{typed->folder, batch_from(*typed)}; }};
}

ParsedCommand run_command(CLI::App& batch) {
  CLI::App* const part =
      batch.add_subcommand("run", "Compute the shards that have no result, and merge");
  part->footer(kBatchRunExamples);
  const auto typed = std::make_shared<BatchRunArguments>();
  const auto folder = std::make_shared<std::string>();
  const auto engine = std::make_shared<std::string>("local");
  const auto raw = std::make_shared<RawAnalysis>();
  part->add_option("FOLDER", *folder, "Folder of the batch")
      ->required()
      ->check(CLI::ExistingDirectory);
  part->add_option(
          "--engine", *engine,
          "Where to compute: child processes on this machine (local) or Slurm job arrays (slurm)")
      ->check(CLI::IsMember({"local", "slurm"}))
      ->capture_default_str();
  part->add_option("--workers", typed->workers, "Number of shards to compute at once")
      ->type_name("COUNT")
      ->default_str("one per processor; with slurm no limit")
      ->check(CLI::Range(1, 100'000));
  part->add_option("--retries", typed->retries, "Number of retries of a shard that left no result")
      ->type_name("COUNT")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  part->add_option("--sbatch", typed->sbatch, "Option to pass to sbatch")
      ->allow_extra_args(false)
      ->type_name("OPTION");
  add_json(*part, *raw);
  add_report(*part, *raw);
  return {part, [typed, folder, engine, raw] {
            BatchRunArguments out = *typed;
            out.folder = *folder;
            out.slurm = *engine == "slurm";
            if (!out.slurm && !out.sbatch.empty()) refuse("--sbatch", "needs --engine slurm");
            out.show = show_from(*raw);
            return out;
          }};
}

ParsedCommand shard_command(CLI::App& batch) {
  CLI::App* const part =
      batch.add_subcommand("shard", "Compute one shard; imunoise batch run starts this");
  part->footer(kBatchShardExamples);
  const auto typed = std::make_shared<BatchShardArguments>();
  const auto folder = std::make_shared<std::string>();
  part->add_option("FOLDER", *folder, "Folder of the batch")
      ->required()
      ->check(CLI::ExistingDirectory);
  part->add_option("NUMBER", typed->number, "Number of the shard, from 0")->required();
  return {part, [typed, folder] { return BatchShardArguments{*folder, typed->number}; }};
}

template <class PartArguments>
ParsedCommand look_command(CLI::App& batch, const char* name, const char* about,
                           const char* examples) {
  CLI::App* const part = batch.add_subcommand(name, about);
  part->footer(examples);
  const auto folder = std::make_shared<std::string>();
  const auto raw = std::make_shared<RawAnalysis>();
  part->add_option("FOLDER", *folder, "Folder of the batch")
      ->required()
      ->check(CLI::ExistingDirectory);
  add_json(*part, *raw);
  add_report(*part, *raw);
  return {part, [folder, raw] { return PartArguments{{*folder, show_from(*raw)}}; }};
}

}  // namespace

std::vector<ParsedCommand> batch_commands(CLI::App& program) {
  CLI::App* const batch =
      program.add_subcommand("batch", "Run many calibrations or simulations, here or on Slurm");
  batch->footer(kBatchExamples);
  batch->require_subcommand(1);
  return {new_command(*batch), run_command(*batch), shard_command(*batch),
          look_command<BatchStatusArguments>(*batch, "status", "Show which shards have a result",
                                             kBatchStatusExamples),
          look_command<BatchMergeArguments>(*batch, "merge", "Combine all results into one report",
                                            kBatchMergeExamples)};
}

}  // namespace imunoise::cli
