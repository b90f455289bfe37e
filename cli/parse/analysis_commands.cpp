#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "cli/parse/commands.h"
#include "cli/parse/input_options.h"
#include "study/analysis/prepare.h"

namespace imunoise::cli {
namespace {

constexpr const char* kFitExamples = R"help(
Examples:
  imunoise fit replicate?_gyro.h5 --channel gyro_x --model "2*AR1 + WN + RW"
  imunoise fit long.npy --split-into 6 --rate 200 --unit "m/s^2" --report acc.html
  imunoise fit run?.csv --model "WN + RES + RW" --weights diag --json > fit.json

Models are sums of: WN white noise, QN quantisation noise, RW random walk, DR drift, AR1 and GM Markov
noise, RES resonance, MA(q), MAVG(n) and BARTLETT(n) filters, FN flicker noise. A value in brackets
stays fixed: WN(sigma2=1e-6). Values are per sample in SI units; GM's tc is in seconds.)help";

constexpr const char* kWvExamples = R"help(
Examples:
  imunoise wv run1.h5                                    every channel, drawn and tabulated
  imunoise wv run?.csv --channel gyro_x --per-octave 4 --json > wv.json
  imunoise wv run1.h5 --robust 0.6                       unmoved by outliers)help";

constexpr const char* kTestExamples = R"help(
Examples:
  imunoise test run?.h5 --channel gyro_x --model "2*AR1 + WN + RW"
  imunoise test run?.h5 --model "AR1 + WN" --bootstrap 999 --seed 1 --report test.html

Two questions: does the model's shape fit every replicate, and do its parameters differ between them?)help";

constexpr const char* kSelectExamples = R"help(
Examples:
  imunoise select run?.h5 --channel gyro_x --model "2*AR1 + WN + RW"     it and all its sub-models
  imunoise select run?.h5 --model "WN + RW" --model "AR1 + WN + RW"      just these
  imunoise select run?.h5 --splits half --weights diag                   CV-WVIC as published)help";

constexpr const char* kArrayExamples = R"help(
Examples:
  imunoise array run?.h5 --channel gyro_a,gyro_b,gyro_c --model "RW[corr] + WN"
  imunoise array run?.csv --optimise long --rule non-negative --report array.html
  imunoise array run?.csv --model "AR1[all] + AR1[group] + WN" --group a,b --group c,d

A sensor is a channel, a file a replicate of all of them. Each sensor has processes of its own unless
the model says: [corr] one of one shape in each sensor, correlated; [group] the same in all sensors
of a group; [all] the same in all.)help";

constexpr const char* kDynamicExamples = R"help(
Examples:
  imunoise dynamic table.h5 --channel gyro_z --covariate rate --model "QN + WN"
  imunoise dynamic 30.csv 90.csv 150.csv --covariate rate --model "QN(q2~exp) + WN(sigma2~linear)"
  imunoise dynamic soak.h5 --covariate temperature --bins 10 --model "AR1(phi~) + WN(sigma2~)"

What follows the covariate c is marked in the model by ~ and, if it is not the first of these, the way:
  a power     sigma2~exp     exp(a + b*c)               sigma2~linear   a + b*c, nowhere negative
  a time      tc~exp         exp(a + b*c)
  other       phi~logistic   logistic(a + b*c) between the bounds of the parameter
Everything else is the same everywhere. A model without ~ stands for one whose powers all follow as exp.)help";

// What the commands of analysis have in common, as it was typed.
struct RawAnalysis {
  RawInput input;
  std::string model;
  CLI::Option* model_option = nullptr;
  std::string weights = "full";
  double confidence = 0.95;
  std::string report;
  bool json = false;
};

std::optional<std::filesystem::path> path_from(const std::string& text) {
  if (text.empty()) return std::nullopt;
  return text;
}

Weighting weighting_from(const std::string& text) {
  return text == "diag" ? Weighting::kDiagonal : Weighting::kFull;
}

// What was typed, were it nothing: an empty model is no request for the default.
std::optional<std::string> model_from(const RawAnalysis& raw) {
  if (raw.model_option->count() == 0) return std::nullopt;
  return raw.model;
}

ShowArguments show_from(const RawAnalysis& raw) { return {raw.json, path_from(raw.report)}; }

void add_json(CLI::App& command, RawAnalysis& raw) {
  command.add_flag("--json", raw.json, "Print the result as JSON");
}

void add_report(CLI::App& command, RawAnalysis& raw) {
  command.add_option("--report", raw.report, "Write one self-contained HTML page")
      ->type_name("OUT.html");
}

void add_model(CLI::App& command, RawAnalysis& raw,
               std::string_view unless_given = study::kDefaultModel) {
  raw.model_option = command.add_option("--model", raw.model,
                                        fmt::format("The model (default: {})", unless_given));
}

void add_weights(CLI::App& command, RawAnalysis& raw) {
  command
      .add_option("--weights", raw.weights,
                  "full: exact covariance of the moments; diag: as the R packages")
      ->check(CLI::IsMember({"full", "diag"}))
      ->capture_default_str();
}

void add_confidence(CLI::App& command, RawAnalysis& raw) {
  command.add_option("--confidence", raw.confidence, "Of the intervals")
      ->check(CLI::Range(0.5, 0.9999))
      ->capture_default_str();
}

ParsedCommand wv_command(CLI::App& program) {
  CLI::App* const wv = program.add_subcommand("wv", "Wavelet variance of recordings");
  wv->footer(kWvExamples);
  const auto raw = std::make_shared<RawAnalysis>();
  add_input(*wv, raw->input);
  add_confidence(*wv, *raw);
  add_json(*wv, *raw);
  return {wv, [raw] {
            WvArguments out{input_from(raw->input), measure_from(raw->input), raw->json};
            out.measure.confidence = raw->confidence;
            return out;
          }};
}

ParsedCommand fit_command(CLI::App& program) {
  CLI::App* const fit = program.add_subcommand("fit", "Fit a noise model to replicates");
  fit->footer(kFitExamples);
  const auto raw = std::make_shared<RawAnalysis>();
  const auto estimator = std::make_shared<std::string>("mugmwm");
  const auto svg = std::make_shared<std::string>();
  add_input(*fit, raw->input);
  add_confidence(*fit, *raw);
  add_json(*fit, *raw);
  add_report(*fit, *raw);
  add_model(*fit, *raw);
  add_weights(*fit, *raw);
  fit->add_option("--estimator", *estimator,
                  "mugmwm: one model for all replicates; agmwm: average of one each")
      ->check(CLI::IsMember({"mugmwm", "agmwm"}))
      ->capture_default_str();
  fit->add_option("--svg", *svg, "Write the noise budget as a picture for papers")
      ->type_name("OUT.svg");
  return {fit, [raw, estimator, svg] {
            FitArguments out;
            out.input = input_from(raw->input);
            out.fit.model = model_from(*raw);
            out.fit.estimator =
                *estimator == "agmwm" ? study::Estimator::kAGmwm : study::Estimator::kMuGmwm;
            out.fit.weighting = weighting_from(raw->weights);
            out.fit.measure = measure_from(raw->input);
            out.fit.confidence = raw->confidence;
            out.json = raw->json;
            out.report = path_from(raw->report);
            out.svg = path_from(*svg);
            return out;
          }};
}

ParsedCommand test_command(CLI::App& program) {
  CLI::App* const test = program.add_subcommand("test", "Are replicates near-stationary?");
  test->footer(kTestExamples);
  const auto raw = std::make_shared<RawAnalysis>();
  const auto bootstrap = std::make_shared<BootstrapOptions>();
  add_input(*test, raw->input);
  add_json(*test, *raw);
  add_report(*test, *raw);
  add_model(*test, *raw);
  test->add_option("--bootstrap", bootstrap->sets,
                   "Sets of a parametric bootstrap: 19 at least, better 999")
      ->check(CLI::Range(0, 1'000'000));
  test->add_option("--seed", bootstrap->seed, "Seed of the bootstrap")->capture_default_str();
  return {test, [raw, bootstrap] {
            TestArguments out{input_from(raw->input), {}, show_from(*raw)};
            out.test.model = model_from(*raw);
            out.test.bootstrap = *bootstrap;
            out.test.measure = measure_from(raw->input);
            return out;
          }};
}

ParsedCommand select_command(CLI::App& program) {
  CLI::App* const select = program.add_subcommand("select", "Which model predicts best?");
  select->footer(kSelectExamples);
  const auto raw = std::make_shared<RawAnalysis>();
  const auto models = std::make_shared<std::vector<std::string>>();
  const auto splits = std::make_shared<std::string>("leave-one-out");
  add_input(*select, raw->input);
  add_json(*select, *raw);
  add_report(*select, *raw);
  add_weights(*select, *raw);
  select
      ->add_option("--model", *models,
                   fmt::format("One: it and its sub-models; several: these (default: {})",
                               study::kDefaultModel))
      ->allow_extra_args(false);
  select
      ->add_option("--splits", *splits,
                   "Held out: each replicate once, or every choice of half of them")
      ->check(CLI::IsMember({"leave-one-out", "half"}))
      ->capture_default_str();
  return {select, [raw, models, splits] {
            SelectArguments out{input_from(raw->input), {}, show_from(*raw)};
            out.select.models = *models;
            out.select.choice.splits = *splits == "half" ? Splits::kHalf : Splits::kLeaveOneOut;
            out.select.choice.weighting = weighting_from(raw->weights);
            out.select.measure = measure_from(raw->input);
            return out;
          }};
}

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

ParsedCommand array_command(CLI::App& program) {
  CLI::App* const array =
      program.add_subcommand("array", "Shared noise and the best virtual sensor of an array");
  array->footer(kArrayExamples);
  const auto raw = std::make_shared<RawAnalysis>();
  const auto groups = std::make_shared<std::vector<std::string>>();
  const auto options = std::make_shared<study::ArraySeriesOptions>();
  const auto rule = std::make_shared<std::string>("unit-gain");
  add_input(*array, raw->input);
  add_confidence(*array, *raw);
  add_json(*array, *raw);
  add_report(*array, *raw);
  add_model(*array, *raw, study::kDefaultArrayModel);
  add_weights(*array, *raw);
  array
      ->add_option("--group", *groups,
                   "Sensors that share the model's [group] processes, e.g. a,b; may be repeated")
      ->allow_extra_args(false);
  array->add_flag("!--no-cross", options->cross, "Fit each sensor's own variances only");
  array
      ->add_option("--optimise", options->scales,
                   "Averaging times at which the virtual sensor is to be quiet: short, long, all, "
                   "or one weight a scale")
      ->capture_default_str();
  array->add_option("--rule", *rule, "What its weights must satisfy")
      ->check(CLI::IsMember({"unit-gain", "non-negative", "unit-length"}))
      ->capture_default_str();
  return {array, [raw, groups, options, rule] {
            if (!raw->input.robust.empty()) refuse("--robust", "not for arrays");
            ArrayArguments out{input_from(raw->input), *options, show_from(*raw)};
            out.array.model = model_from(*raw);
            for (const std::string& group : *groups) out.array.groups.push_back(names_in(group));
            out.array.per_octave = raw->input.per_octave;
            out.array.confidence = raw->confidence;
            out.array.weighting = weighting_from(raw->weights);
            out.array.rule = rule_from(*rule);
            return out;
          }};
}

// Where the bins are: "8" is how many, "30,90" are places.
void set_bins(const std::string& text, study::CovariateOptions& to) {
  if (text == "auto") return;
  for (const std::string& one : CLI::detail::split(text, ',')) {
    double value = 0.0;
    if (one.empty()) continue;
    if (!CLI::detail::lexical_cast(one, value) || !std::isfinite(value)) {
      refuse("--bins", "expected auto, how many, or places such as 30,90,150");
    }
    to.values.push_back(value);
  }
  if (to.values.size() > 1) return;
  const bool place = text.find(',') != std::string::npos;
  const double count = place || to.values.empty() ? 0.0 : to.values.front();
  if (!(count >= 2.0 && count <= 1000.0 && count == std::floor(count))) {
    refuse("--bins", "at least two, and at most 1000");
  }
  to.count = static_cast<std::size_t>(count);
  to.values.clear();
}

ParsedCommand dynamic_command(CLI::App& program) {
  CLI::App* const dynamic =
      program.add_subcommand("dynamic", "How noise follows a covariate: rate, temperature, ...");
  dynamic->footer(kDynamicExamples);
  const auto raw = std::make_shared<RawAnalysis>();
  const auto covariate = std::make_shared<study::CovariateOptions>();
  const auto bins = std::make_shared<std::string>("auto");
  add_input(*dynamic, raw->input);
  add_confidence(*dynamic, *raw);
  add_json(*dynamic, *raw);
  add_report(*dynamic, *raw);
  add_model(*dynamic, *raw, study::kDefaultDynamicModel);
  dynamic->add_option("--covariate", covariate->channel, "The channel that noise may follow")
      ->required();
  dynamic->add_option("--covariate-unit", covariate->unit,
                      "What its numbers are called (default: as the file says)");
  dynamic
      ->add_option("--bins", *bins,
                   "Where noise is measured: places such as 30,90,150; or how many bins of equal "
                   "size; auto: where the covariate stays, else 8 bins")
      ->capture_default_str();
  dynamic
      ->add_option("--settle", covariate->settle_s,
                   "Seconds left out after the covariate arrives at a bin")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  return {dynamic, [raw, covariate, bins] {
            DynamicArguments out{input_from(raw->input), {}, show_from(*raw)};
            out.dynamic.covariate = *covariate;
            set_bins(*bins, out.dynamic.covariate);
            // A unit that was typed is that of the channels; the covariate's is then unknown.
            if (out.input.import.unit && covariate->unit.empty()) out.dynamic.covariate.unit = "1";
            std::vector<std::string>& read = out.input.import.channels;
            out.dynamic.channels = read;
            if (!read.empty() &&
                std::find(read.begin(), read.end(), covariate->channel) == read.end()) {
              read.push_back(covariate->channel);
            }
            out.dynamic.model = model_from(*raw);
            out.dynamic.measure = measure_from(raw->input);
            out.dynamic.confidence = raw->confidence;
            return out;
          }};
}

}  // namespace

std::vector<ParsedCommand> analysis_commands(CLI::App& program) {
  return {wv_command(program),     fit_command(program),   test_command(program),
          select_command(program), array_command(program), dynamic_command(program)};
}

}  // namespace imunoise::cli
