#include <memory>

#include "cli/parse/commands.h"
#include "cli/parse/raw_analysis.h"

namespace imunoise::cli {
namespace {

constexpr const char* kArrayExamples = R"help(
Examples:
  imunoise array run?.h5 --channel gyro_a,gyro_b,gyro_c --model "RW[corr] + WN"
  imunoise array run?.csv --optimise long --rule non-negative --report array.html
  imunoise array run?.csv --model "AR1[all] + AR1[group] + WN" --group a,b --group c,d

Each channel is a sensor; each file is one replicate of all sensors. By default every sensor has its own
processes. Mark a process to share it: [corr] one per sensor, equal in shape and correlated; [group] one
common to the sensors of a group; [all] one common to all sensors.)help";

constexpr const char* kMixedExamples = R"help(
Examples:
  imunoise mixed sites.csv --rate 0.1 --regress temperature --model "AR1[all] + AR1 + WN"
  imunoise mixed sites.csv --rate 1 --regress time --regress "t=t_a,t_b" --channel a,b
  imunoise mixed sites.csv --rate 1 --regress temperature --group a,b --group c,d \
      --model "RES[all] + AR1[group] + WN" --bootstrap 999 --report mixed.html

Each channel of a file is a series. The channels given by --regress explain all others: every series gets
its own constant and one coefficient per regressor. Series can share noise, as in imunoise array.)help";

constexpr const char* kFaultsExamples = R"help(
Examples:
  imunoise faults today.h5 --train static?.h5 --model "AR1 + WN + RW[corr]"
  imunoise faults run?.csv --channel gyro_a,gyro_b,gyro_c --false-alarms-per-hour 0.001 --report f.html

The sensors must measure the same motion, such as three gyroscopes about one axis. Use at least three: if
two sensors disagree, the data cannot show which one is wrong.)help";

WeightRule rule_from(const std::string& text) {
  if (text == "non-negative") return WeightRule::kNonnegative;
  return text == "unit-length" ? WeightRule::kUnitLength : WeightRule::kUnitGain;
}

std::vector<std::string> names_in(const std::string& list) {
  std::vector<std::string> out;
  for (const std::string& name : CLI::detail::split(list, ',')) {
    if (!name.empty()) out.push_back(name);
  }
  return out;
}

void add_groups(CLI::App& command, std::vector<std::string>& groups) {
  command.add_option("--group", groups, "Sensors that share the [group] processes, such as a,b")
      ->type_name("NAMES")
      ->allow_extra_args(false);
}

ParsedCommand array_command(CLI::App& program) {
  CLI::App* const array = program.add_subcommand(
      "array", "Find the noise that sensors share, and weights of the quietest virtual sensor");
  array->footer(kArrayExamples);
  const auto raw = std::make_shared<RawAnalysis>();
  const auto groups = std::make_shared<std::vector<std::string>>();
  const auto options = std::make_shared<study::ArraySeriesOptions>();
  const auto rule = std::make_shared<std::string>("unit-gain");
  add_input(*array, raw->input);
  add_scales(*array, raw->input);
  add_confidence(*array, *raw);
  add_json(*array, *raw);
  add_report(*array, *raw);
  add_model(*array, *raw, study::kDefaultArrayModel);
  add_weights(*array, *raw);
  add_groups(*array, *groups);
  array->add_flag("!--no-cross", options->cross,
                  "Fit variances only, without cross-covariances between sensors");
  const auto estimator = std::make_shared<std::string>("mgmwm");
  array
      ->add_option("--estimator", *estimator,
                   "Estimator: wavelet moments (mgmwm), or the maximum of the Whittle likelihood "
                   "started from them, for short recordings (whittle)")
      ->check(CLI::IsMember({"mgmwm", "whittle"}))
      ->capture_default_str();
  array
      ->add_option("--optimise", options->scales,
                   "Averaging times at which to minimise the noise of the virtual sensor: short, "
                   "long, all, or one weight per scale")
      ->type_name("SCALES")
      ->capture_default_str();
  array->add_option("--rule", *rule, "Constraint on the weights of the virtual sensor")
      ->check(CLI::IsMember({"unit-gain", "non-negative", "unit-length"}))
      ->capture_default_str();
  return {array, [raw, groups, options, rule, estimator] {
            ArrayArguments out{input_from(raw->input), *options, show_from(*raw)};
            out.array.model = model_from(*raw);
            for (const std::string& group : *groups) out.array.groups.push_back(names_in(group));
            out.array.per_octave = raw->input.per_octave;
            out.array.confidence = raw->confidence;
            out.array.weighting = weighting_from(raw->weights);
            out.array.rule = rule_from(*rule);
            out.array.efficient = *estimator == "whittle";
            return out;
          }};
}

ParsedCommand mixed_command(CLI::App& program) {
  CLI::App* const mixed =
      program.add_subcommand("mixed", "Regress series on covariates while they share noise");
  mixed->footer(kMixedExamples);
  const auto raw = std::make_shared<RawAnalysis>();
  const auto groups = std::make_shared<std::vector<std::string>>();
  const auto options = std::make_shared<study::MixedSeriesOptions>();
  add_input(*mixed, raw->input);
  add_confidence(*mixed, *raw);
  add_json(*mixed, *raw);
  add_report(*mixed, *raw);
  add_model(*mixed, *raw, study::kDefaultMixedModel);
  mixed
      ->add_option("--regress", options->regressors,
                   "Regressor: a channel, time, or NAME=a,b,c with one channel per series")
      ->type_name("REGRESSOR")
      ->allow_extra_args(false)
      ->required();
  mixed->add_option("--group", *groups, "Series that share the [group] processes, such as a,b")
      ->type_name("NAMES")
      ->allow_extra_args(false);
  mixed
      ->add_option(
          "--bootstrap", options->regression.bootstraps,
          "Number of bootstrap sets for the test of the coefficients, at least 19; 0 disables it")
      ->type_name("COUNT")
      ->check(CLI::Range(0, 1'000'000))
      ->capture_default_str();
  mixed->add_option("--seed", options->regression.seed, "Random seed of the bootstrap")
      ->type_name("SEED")
      ->capture_default_str();
  return {mixed, [raw, groups, options] {
            MixedArguments out{input_from(raw->input), *options, show_from(*raw)};
            out.mixed.model = model_from(*raw);
            for (const std::string& group : *groups) out.mixed.groups.push_back(names_in(group));
            out.mixed.regression.confidence = raw->confidence;
            return out;
          }};
}

ParsedCommand faults_command(CLI::App& program) {
  CLI::App* const faults = program.add_subcommand(
      "faults", "Find the sensor of an array that steps, sticks or grows noisy");
  faults->footer(kFaultsExamples);
  const auto raw = std::make_shared<RawAnalysis>();
  const auto groups = std::make_shared<std::vector<std::string>>();
  const auto training = std::make_shared<std::vector<std::string>>();
  const auto options = std::make_shared<study::FaultSeriesOptions>();
  add_input(*faults, raw->input);
  add_scales(*faults, raw->input);
  add_json(*faults, *raw);
  add_report(*faults, *raw);
  add_model(*faults, *raw, study::kDefaultArrayModel);
  add_weights(*faults, *raw);
  add_groups(*faults, *groups);
  faults
      ->add_option("--train", *training, "Static recordings of healthy sensors to fit the model to")
      ->allow_extra_args(true)
      ->type_name("FILES")
      ->default_str("the analysed files");
  faults
      ->add_option(
          "--false-alarms-per-hour", options->false_alarms_per_hour,
          "Allowed false alarms of a healthy array (per hour), over all sensors and faults")
      ->type_name("RATE")
      ->check(CLI::Range(1e-9, 1000.0))
      ->capture_default_str();
  return {faults, [raw, groups, training, options] {
            FaultsArguments out{input_from(raw->input), {}, *options, show_from(*raw)};
            RawInput good = raw->input;
            good.files = *training;
            out.training = input_from(good);
            out.faults.model = model_from(*raw);
            for (const std::string& group : *groups) out.faults.groups.push_back(names_in(group));
            out.faults.per_octave = raw->input.per_octave;
            out.faults.weighting = weighting_from(raw->weights);
            return out;
          }};
}

}  // namespace

std::vector<ParsedCommand> array_commands(CLI::App& program) {
  return {array_command(program), mixed_command(program), faults_command(program)};
}

}  // namespace imunoise::cli
