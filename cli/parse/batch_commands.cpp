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

A batch is a folder of shards. run works on those without a result, as often as it is called, and merges in
the end.)help";

constexpr const char* kNewExamples = R"help(
--calibrate does for each recording what imunoise calibrate does, and takes its options. --simulate fits a model to each of
--sets simulated sets: what would recordings of such a length show?)help";

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
  task.add_option("--calibrate", typed.recordings, "Folders of recordings")
      ->check(CLI::ExistingDirectory)
      ->type_name("RECORDING");
  typed.settings.set_diagnose(true);
  typed.settings.set_seed(BootstrapOptions{}.seed);
  part.add_option_function<std::vector<std::string>>(
          "--channel",
          [&typed](const std::vector<std::string>& names) {
            typed.settings.mutable_channels()->Assign(names.begin(), names.end());
          },
          "A channel; repeatable (default: all angular rates and accelerations)")
      ->delimiter(',')
      ->allow_extra_args(false);
  part.add_flag_callback(
      "--no-diagnose", [&typed] { typed.settings.set_diagnose(false); },
      "Do not seek effects that are missing");
  part.add_flag_callback(
      "--array", [&typed] { typed.settings.set_array(true); },
      "Channels of one quantity as an array, too");
  add_field(part, "--bootstrap", typed.settings, &v1::CalibrationSettings::set_bootstrap_sets,
            "Sets of the bootstrap of the test between replicates")
      ->check(CLI::Range(0, 1'000'000));
}

void add_simulation(CLI::App& part, RawNew& typed, CLI::Option_group& task) {
  v1::SimulationTask& to = typed.simulate;
  task.add_option_function<std::string>(
      "--simulate", [&to](const std::string& model) { to.set_model(model); },
      "The true model, with all its values");
  to.set_replicates(1);
  to.set_seed(1);
  add_field(part, "--rate", to, &v1::SimulationTask::set_rate_hz, "Sampling rate in Hz")
      ->check(CLI::PositiveNumber);
  add_field(part, "--samples", to, &v1::SimulationTask::set_samples, "Samples of each replicate")
      ->check(CLI::Range(std::uint64_t{16}, std::uint64_t{1} << 32U));
  add_field(part, "--replicates", to, &v1::SimulationTask::set_replicates,
            "Replicates of each set (default: 1)")
      ->check(CLI::Range(1, 100'000));
  add_field(part, "--sets", to, &v1::SimulationTask::set_sets, "How many sets")
      ->check(CLI::Range(1, 100'000'000));
  part.add_option_function<std::uint64_t>(
      "--seed",
      [&typed](const std::uint64_t& seed) {
        typed.simulate.set_seed(seed);
        typed.settings.set_seed(seed);
      },
      "Seed of the simulation, or of the bootstrap (default: 1)");
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
    if (task.rate_hz() == 0.0) refuse("--rate", "is needed with --simulate");
    if (task.samples() == 0) refuse("--samples", "is needed with --simulate");
    if (task.sets() == 0) refuse("--sets", "is needed with --simulate");
    task.set_confidence(typed.raw.confidence);
    const auto form = study::form_of(task.model(), task.rate_hz());
    if (!form) refuse("--simulate", form.error().message);
    if (typed.models.size() > 1) refuse("--model", "one is fitted to simulated sets");
    task.set_fit(typed.models.empty() ? *form : typed.models.front());
  }
  out.set_shard_size(typed.shard_size > 0 ? typed.shard_size : study::default_shard_size(out));
  return out;
}

ParsedCommand new_command(CLI::App& batch) {
  CLI::App* const part = batch.add_subcommand("new", "Make a batch");
  part->footer(kNewExamples);
  const auto typed = std::make_shared<RawNew>();
  part->add_option("FOLDER", typed->folder, "The batch's folder; made here")->required();
  CLI::Option_group* const task = part->add_option_group("task", "What is to be done");
  add_calibration(*part, *typed, *task);
  add_simulation(*part, *typed, *task);
  task->require_option(1);
  part->add_option("--model", typed->models,
                   "To fit; with --calibrate several to choose of (default: chosen; with "
                   "--simulate the true one's form)")
      ->allow_extra_args(false);
  add_confidence(*part, typed->raw);
  part->add_option("--shard-size", typed->shard_size,
                   "Recordings, or sets, of one shard (default: 1, or a hundredth)")
      ->check(CLI::Range(1, 100'000'000));
  return {part, [typed] { return BatchNewArguments{typed->folder, batch_from(*typed)}; }};
}

ParsedCommand run_command(CLI::App& batch) {
  CLI::App* const part = batch.add_subcommand("run", "Work on the shards without a result");
  const auto typed = std::make_shared<BatchRunArguments>();
  const auto folder = std::make_shared<std::string>();
  const auto engine = std::make_shared<std::string>("local");
  const auto raw = std::make_shared<RawAnalysis>();
  part->add_option("FOLDER", *folder, "The batch's folder")
      ->required()
      ->check(CLI::ExistingDirectory);
  part->add_option("--engine", *engine, "local: child processes here; slurm: job arrays")
      ->check(CLI::IsMember({"local", "slurm"}))
      ->capture_default_str();
  part->add_option("--workers", typed->workers,
                   "How many at once (default: local: as many as processors; slurm: no limit)")
      ->check(CLI::Range(1, 100'000));
  part->add_option("--retries", typed->retries,
                   "How often a shard that left no result is tried again")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  part->add_option("--sbatch", typed->sbatch, "An option for sbatch; repeatable")
      ->allow_extra_args(false)
      ->type_name("OPTION");
  add_json(*part, *raw);
  add_report(*part, *raw);
  return {part, [typed, folder, engine, raw] {
            BatchRunArguments out = *typed;
            out.folder = *folder;
            out.slurm = *engine == "slurm";
            if (!out.slurm && !out.sbatch.empty()) refuse("--sbatch", "is for --engine slurm");
            out.show = show_from(*raw);
            return out;
          }};
}

ParsedCommand shard_command(CLI::App& batch) {
  CLI::App* const part =
      batch.add_subcommand("shard", "Work on one shard: what run lets its workers do");
  const auto typed = std::make_shared<BatchShardArguments>();
  const auto folder = std::make_shared<std::string>();
  part->add_option("FOLDER", *folder, "The batch's folder")
      ->required()
      ->check(CLI::ExistingDirectory);
  part->add_option("NUMBER", typed->number, "The shard's, from 0")->required();
  return {part, [typed, folder] { return BatchShardArguments{*folder, typed->number}; }};
}

template <class PartArguments>
ParsedCommand look_command(CLI::App& batch, const char* name, const char* about) {
  CLI::App* const part = batch.add_subcommand(name, about);
  const auto folder = std::make_shared<std::string>();
  const auto raw = std::make_shared<RawAnalysis>();
  part->add_option("FOLDER", *folder, "The batch's folder")
      ->required()
      ->check(CLI::ExistingDirectory);
  add_json(*part, *raw);
  add_report(*part, *raw);
  return {part, [folder, raw] { return PartArguments{{*folder, show_from(*raw)}}; }};
}

}  // namespace

std::vector<ParsedCommand> batch_commands(CLI::App& program) {
  CLI::App* const batch =
      program.add_subcommand("batch", "Many calibrations or simulations, here or on Slurm");
  batch->footer(kBatchExamples);
  batch->require_subcommand(1);
  return {new_command(*batch), run_command(*batch), shard_command(*batch),
          look_command<BatchStatusArguments>(*batch, "status", "Which shards have a result"),
          look_command<BatchMergeArguments>(*batch, "merge", "Put all results together")};
}

}  // namespace imunoise::cli
