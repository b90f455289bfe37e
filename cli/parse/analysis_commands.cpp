#include <algorithm>
#include <cmath>
#include <memory>

#include "cli/parse/commands.h"
#include "cli/parse/raw_analysis.h"

namespace imunoise::cli {
namespace {

constexpr const char* kFitExamples = R"help(
Examples:
  imunoise fit replicate?_gyro.h5 --channel gyro_x --model "2*AR1 + WN + RW"
  imunoise fit long.npy --split-into 6 --rate 200 --unit "m/s^2" --report acc.html
  imunoise fit run?.csv --model "WN + RES + RW" --weights diag --json > fit.json
  imunoise fit run?.csv --model "WN + RW" --fail-if-misfit     for scripts: exit status 3 if it does not fit

A model is a sum of processes: WN white noise, QN quantisation noise, RW random walk, DR rate ramp,
AR1 and GM Markov noise, AR2 second-order noise, RES and VOIGT resonances, FN flicker noise, PL
power-law noise, and the filters MA(q), MAVG(n), BARTLETT(n), LOWPASS(n) and BUTTERWORTH(n). A
value in brackets stays fixed: WN(sigma2=1e-6). Values are per sample, in SI units; tc of GM is in
s.)help";

constexpr const char* kWvExamples = R"help(
Examples:
  imunoise wv run1.h5                                    every channel: a plot and a table
  imunoise wv run?.csv --channel gyro_x --per-octave 4 --json > wv.json
  imunoise wv run1.h5 --robust 0.6                       resists outliers
  imunoise wv run?.h5 --allan --report allan.html        Allan deviation and bias instability)help";

constexpr const char* kTestExamples = R"help(
Examples:
  imunoise test run?.h5 --channel gyro_x --model "2*AR1 + WN + RW"
  imunoise test run?.h5 --model "AR1 + WN" --bootstrap 999 --seed 1 --report test.html

The test answers two questions. Does the model fit every replicate? Do its parameters differ between
replicates?)help";

constexpr const char* kSelectExamples = R"help(
Examples:
  imunoise select run?.h5 --channel gyro_x --model "2*AR1 + WN + RW"     this model and its sub-models
  imunoise select run?.h5 --model "WN + RW" --model "AR1 + WN + RW"      only these two
  imunoise select run?.h5 --splits half --weights diag                   CV-WVIC as published)help";

constexpr const char* kDynamicExamples = R"help(
Examples:
  imunoise dynamic table.h5 --channel gyro_z --covariate rate --model "QN + WN"
  imunoise dynamic 30.csv 90.csv 150.csv --covariate rate --model "QN(q2~exp) + WN(sigma2~linear)"
  imunoise dynamic soak.h5 --covariate temperature --bins 10 --model "AR1(phi~) + WN(sigma2~)"

Mark a parameter that depends on the covariate c with ~ and, optionally, the form of the dependence:
  power        sigma2~exp (default): exp(a + b*c)      sigma2~linear: a + b*c, never negative
  time         tc~exp: exp(a + b*c)
  other        phi~logistic: logistic(a + b*c) between the bounds of the parameter

All other parameters are constant. In a model without ~, every power depends on c with the form exp.)help";

study::Estimator estimator_from(const std::string& text) {
  if (text == "agmwm") return study::Estimator::kAGmwm;
  return text == "whittle" ? study::Estimator::kWhittle : study::Estimator::kMuGmwm;
}

ParsedCommand wv_command(CLI::App& program) {
  CLI::App* const wv = program.add_subcommand("wv", "Measure the wavelet variance of recordings");
  wv->footer(kWvExamples);
  const auto raw = std::make_shared<RawAnalysis>();
  add_input(*wv, raw->input);
  add_measure(*wv, raw->input);
  add_confidence(*wv, *raw);
  add_json(*wv, *raw);
  add_report(*wv, *raw);
  const auto allan = std::make_shared<bool>(false);
  const auto hadamard = std::make_shared<bool>(false);
  const auto svg = std::make_shared<std::string>();
  auto* const of_allan = wv->add_flag(
      "--allan", *allan, "Show the overlapping Allan deviation at 1, 2, 4, 10, ... samples");
  wv->add_flag("--hadamard", *hadamard,
               "Show the overlapping Hadamard deviation, which does not see a ramp")
      ->excludes(of_allan);
  wv->add_option("--svg", *svg, "SVG picture of each deviation to write")->type_name("OUT.svg");
  return {
      wv, [raw, allan, hadamard, svg] {
        WvArguments out{input_from(raw->input), measure_from(raw->input), {}, show_from(*raw), {}};
        out.measure.confidence = raw->confidence;
        if (*allan) out.deviation = DeviationKind::kAllan;
        if (*hadamard) out.deviation = DeviationKind::kHadamard;
        out.svg = output_from("--svg", *svg, *raw);
        if (!out.deviation && (out.show.report || out.svg))
          refuse(out.svg ? "--svg" : "--report", "needs --allan or --hadamard");
        if (out.deviation && out.measure.robust)
          refuse("--robust", "is for the wavelet variance, not for deviations");
        if (out.deviation && out.measure.per_octave != 1)
          refuse("--per-octave", "is for the wavelet variance, not for deviations");
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
  add_measure(*fit, raw->input);
  add_confidence(*fit, *raw);
  add_json(*fit, *raw);
  add_report(*fit, *raw);
  add_model(*fit, *raw);
  add_weights(*fit, *raw);
  fit->add_option(
         "--estimator", *estimator,
         "Estimator: one fit to all replicates (mugmwm), mean of one fit per replicate (agmwm), "
         "or the maximum of the Whittle likelihood, started from mugmwm (whittle)")
      ->check(CLI::IsMember({"mugmwm", "agmwm", "whittle"}))
      ->capture_default_str();
  fit->add_option("--svg", *svg, "SVG picture of the noise budget to write, for papers")
      ->type_name("OUT.svg");
  const auto strict = std::make_shared<bool>(false);
  fit->add_flag("--fail-if-misfit", *strict,
                "Exit status 3 if the model does not fit a channel (p < 1 %)");
  return {fit, [raw, estimator, svg, strict] {
            FitArguments out;
            out.fail_if_misfit = *strict;
            out.input = input_from(raw->input);
            out.fit.model = model_from(*raw);
            out.fit.estimator = estimator_from(*estimator);
            out.fit.weighting = weighting_from(raw->weights);
            out.fit.measure = measure_from(raw->input);
            out.fit.confidence = raw->confidence;
            out.json = raw->json;
            out.report = output_from("--report", raw->report, *raw);
            out.svg = output_from("--svg", *svg, *raw);
            return out;
          }};
}

ParsedCommand test_command(CLI::App& program) {
  CLI::App* const test =
      program.add_subcommand("test", "Test whether replicates are near-stationary");
  test->footer(kTestExamples);
  const auto raw = std::make_shared<RawAnalysis>();
  const auto bootstrap = std::make_shared<BootstrapOptions>();
  add_input(*test, raw->input);
  add_measure(*test, raw->input);
  add_json(*test, *raw);
  add_report(*test, *raw);
  add_model(*test, *raw);
  test->add_option(
          "--bootstrap", bootstrap->sets,
          "Number of bootstrap sets, at least 19, better 999; 0 uses asymptotic p-values only")
      ->type_name("COUNT")
      ->check(CLI::Range(0, 1'000'000))
      ->capture_default_str();
  test->add_option("--seed", bootstrap->seed, "Random seed of the bootstrap")
      ->type_name("SEED")
      ->capture_default_str();
  return {test, [raw, bootstrap] {
            TestArguments out{input_from(raw->input), {}, show_from(*raw)};
            out.test.model = model_from(*raw);
            out.test.bootstrap = *bootstrap;
            out.test.measure = measure_from(raw->input);
            return out;
          }};
}

ParsedCommand select_command(CLI::App& program) {
  CLI::App* const select = program.add_subcommand(
      "select", "Choose the simplest model that predicts held-out data best");
  select->footer(kSelectExamples);
  const auto raw = std::make_shared<RawAnalysis>();
  const auto models = std::make_shared<std::vector<std::string>>();
  const auto splits = std::make_shared<std::string>("leave-one-out");
  add_input(*select, raw->input);
  add_measure(*select, raw->input);
  add_json(*select, *raw);
  add_report(*select, *raw);
  add_weights(*select, *raw);
  select
      ->add_option(
          "--model", *models,
          "Model to try; give one to compare it with its sub-models, or several to compare "
          "only these")
      ->type_name("MODEL")
      ->default_str(std::string(study::kDefaultModel))
      ->allow_extra_args(false);
  select->add_option("--splits", *splits, "Replicates held out in turn: each one, or every half")
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

// "8" is a number of bins, "30,90" are their centres.
void set_bins(const std::string& text, study::CovariateOptions& to) {
  if (text == "auto") return;
  for (const std::string& one : CLI::detail::split(text, ',')) {
    double value = 0.0;
    if (one.empty()) continue;
    if (!CLI::detail::lexical_cast(one, value) || !std::isfinite(value)) {
      refuse("--bins", "expected auto, a number of bins, or bin centres such as 30,90,150");
    }
    to.values.push_back(value);
  }
  if (to.values.size() > 1) return;
  const bool place = text.find(',') != std::string::npos;
  const double count = place || to.values.empty() ? 0.0 : to.values.front();
  if (!(count >= 2.0 && count <= 1000.0 && count == std::floor(count))) {
    refuse("--bins", "expected 2 to 1000 bins");
  }
  to.count = static_cast<std::size_t>(count);
  to.values.clear();
}

ParsedCommand dynamic_command(CLI::App& program) {
  CLI::App* const dynamic = program.add_subcommand(
      "dynamic", "Fit noise that depends on a covariate such as rotation rate or temperature");
  dynamic->footer(kDynamicExamples);
  const auto raw = std::make_shared<RawAnalysis>();
  const auto covariate = std::make_shared<study::CovariateOptions>();
  const auto bins = std::make_shared<std::string>("auto");
  add_input(*dynamic, raw->input);
  add_measure(*dynamic, raw->input);
  add_confidence(*dynamic, *raw);
  add_json(*dynamic, *raw);
  add_report(*dynamic, *raw);
  add_model(*dynamic, *raw, study::kDefaultDynamicModel);
  dynamic->add_option("--covariate", covariate->channel, "Channel that the noise may depend on")
      ->type_name("CHANNEL")
      ->required();
  dynamic
      ->add_option("--covariate-unit", covariate->unit,
                   "Unit of the covariate, shown in the report")
      ->type_name("UNIT")
      ->default_str("the file's");
  dynamic
      ->add_option(
          "--bins", *bins,
          "Bins of the covariate: centres such as 30,90,150, or a number of equal bins; auto "
          "finds plateaus of the covariate, else makes 8 bins")
      ->type_name("BINS")
      ->capture_default_str();
  dynamic
      ->add_option("--settle", covariate->settle_s,
                   "Time to discard after the covariate enters a bin (s)")
      ->type_name("SECONDS")
      ->check(zero_or_above())
      ->capture_default_str();
  return {dynamic, [raw, covariate, bins] {
            DynamicArguments out{input_from(raw->input), {}, show_from(*raw)};
            out.dynamic.covariate = *covariate;
            set_bins(*bins, out.dynamic.covariate);
            // A unit that was typed is that of the channels; the covariate's is then unknown.
            if (!out.input.import.units.empty() && covariate->unit.empty())
              out.dynamic.covariate.unit = "1";
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
  return {wv_command(program), fit_command(program), test_command(program), select_command(program),
          dynamic_command(program)};
}

}  // namespace imunoise::cli
