#include "python/analyses.h"

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include <cmath>

#include "core/support/nearest_word.h"
#include "python/job.h"
#include "study/analysis/arrays/array_series.h"
#include "study/analysis/diagnose_series.h"
#include "study/analysis/fit_series.h"
#include "study/analysis/preflights.h"
#include "study/deviation/deviations.h"
#include "study/export/export.h"
#include "study/export/known_consumers.h"
#include "study/export/sha256.h"
#include "study/export/source.h"
#include "study/ladder/study.h"
#include "study/ladder/study_file.h"
#include "study/report/json.h"

namespace imunoise::python {
namespace {

namespace py = pybind11;

template <class Choice>
using Choices = std::vector<std::pair<std::string_view, Choice>>;

template <class Choice>
Choice choose(std::string_view name, const std::string& text, const Choices<Choice>& choices) {
  std::string known;
  for (const auto& [word, choice] : choices) {
    if (word == text) return choice;
    known += fmt::format("{}{}", known.empty() ? "" : ", ", word);
  }
  throw Failure(fmt::format("{}: '{}' is none of {}", name, text, known));
}

double level(std::string_view name, double value) {
  if (!(value > 0.0 && value < 1.0))
    throw Failure(fmt::format("{}: expected a number between 0 and 1", name));
  return value;
}

study::MeasureOptions options_of(const Measuring& from) {
  study::MeasureOptions out;
  out.per_octave =
      choose<int>("per_octave", std::to_string(from.per_octave), {{"1", 1}, {"2", 2}, {"4", 4}});
  out.confidence = level("confidence", from.confidence);
  if (from.robust)
    out.robust = choose<RobustEfficiency>("robust", fmt::format("{:g}", *from.robust),
                                          {{"0.6", RobustEfficiency::k60},
                                           {"0.8", RobustEfficiency::k80},
                                           {"0.9", RobustEfficiency::k90}});
  return out;
}

// Checked: series_of() needs a channel that is there.
study::Series series(const Recording& recording, std::size_t channel) {
  recording.channel(0, channel);
  return study::series_of(recording.replicates, channel);
}

}  // namespace

std::string wavelet_variance(const Recording& recording, std::size_t channel,
                             const Measuring& measuring, const py::object& progress) {
  const study::Series of = series(recording, channel);
  const study::MeasureOptions options = options_of(measuring);
  const auto measured =
      run([&](const Progress& told) { return study::measure(of, options, told); }, progress);
  v1::WaveletVarianceReport out = study::wavelet_report(of, measured);
  study::add_preflight(recording.replicates, out);
  return report::to_json(out);
}

std::string deviation(const Recording& recording, std::size_t channel, const std::string& kind,
                      double confidence) {
  const study::Series of = series(recording, channel);
  const auto which = choose<DeviationKind>(
      "kind", kind, {{"allan", DeviationKind::kAllan}, {"hadamard", DeviationKind::kHadamard}});
  const double at = level("confidence", confidence);
  v1::DeviationReport out =
      run([&](const Progress&) { return study::deviations(of, which, at); }, py::none());
  study::add_preflight(recording.replicates, out);
  return report::to_json(out);
}

std::string fit(const Recording& recording, std::size_t channel, const Text& model,
                const std::string& estimator, const std::string& weights,
                const Measuring& measuring, const py::object& progress) {
  const study::Series of = series(recording, channel);
  study::FitOptions options;
  options.model = model;
  options.estimator = choose<study::Estimator>("estimator", estimator,
                                               {{"mugmwm", study::Estimator::kMuGmwm},
                                                {"agmwm", study::Estimator::kAGmwm},
                                                {"whittle", study::Estimator::kWhittle}});
  options.weighting = choose<Weighting>(
      "weights", weights, {{"full", Weighting::kFull}, {"diag", Weighting::kDiagonal}});
  options.measure = options_of(measuring);
  // The intervals of the fit alone: those of the moments make the diagonal weights.
  options.confidence = std::exchange(options.measure.confidence, 0.95);
  v1::FitReport out =
      run([&](const Progress& told) { return study::fit_series(of, options, told); }, progress);
  study::add_preflight(recording.replicates, out);
  return report::to_json(out);
}

std::string diagnose(const Recording& recording, std::size_t channel, const Text& model,
                     const Words& witnesses, bool automatic, double false_alarms,
                     const py::object& progress) {
  recording.channel(0, channel);
  study::DiagnoseOptions options;
  options.model = model;
  options.witnesses = witnesses;
  options.automatic = automatic;
  options.level = level("level", false_alarms);
  v1::DiagnosisReport out = run(
      [&](const Progress& told) {
        return study::diagnose_series(recording.replicates, channel, options, told);
      },
      progress);
  study::add_preflight(recording.replicates, out);
  return report::to_json(out);
}

std::string array(const Recording& recording, const std::vector<std::size_t>& channels,
                  const Text& model, const std::vector<Words>& groups, const std::string& scales,
                  const std::string& rule, bool efficient, double confidence,
                  const py::object& progress) {
  std::vector<study::Series> sensors;
  for (const std::size_t one : channels) sensors.push_back(series(recording, one));
  study::ArraySeriesOptions options;
  options.model = model;
  options.groups = groups;
  options.scales = scales;
  options.efficient = efficient;
  options.confidence = level("confidence", confidence);
  options.rule = choose<WeightRule>("rule", rule,
                                    {{"unit-gain", WeightRule::kUnitGain},
                                     {"nonnegative", WeightRule::kNonnegative},
                                     {"unit-length", WeightRule::kUnitLength}});
  v1::ArrayReport out = run(
      [&](const Progress& told) { return study::array_series(sensors, options, told); }, progress);
  study::add_preflight(recording.replicates, out);
  return report::to_json(out);
}

std::string study(const Recording& recording, const std::string& study, const std::string& request,
                  const py::object& progress) {
  v1::Study before;
  if (!study.empty()) before = value_of(study::parse_study(study));
  v1::StudyRequest asked;
  if (const auto read = google::protobuf::util::JsonStringToMessage(request, &asked); !read.ok())
    throw Failure("study: " + std::string(read.message()));
  const auto read = [&](const v1::StudyInput&, const std::string&) {
    return Result<std::vector<recording::Replicate>>(recording.replicates);
  };
  return study::study_text(
      run([&](const Progress& told) { return study::apply(before, asked, read, told); }, progress));
}

std::string export_noise(const std::string& fits, const std::string& to, const Text& axis,
                         bool conservative, std::pair<double, double> horizon,
                         std::optional<double> step, const std::string& source) {
  const study::Consumer* const consumer = study::consumer_called(to);
  if (consumer == nullptr) {
    Words names;
    for (const study::Consumer* const one : study::known_consumers()) names.emplace_back(one->name);
    const std::string meant = did_you_mean(to, names);
    throw Failure(fmt::format("to: '{}' is none of {}{}", to, study::consumer_names(),
                              meant.empty() ? "" : "; " + meant));
  }
  study::ExportOptions options;
  if (axis)
    options.axes = choose<study::AxisRule>("axis", *axis,
                                           {{"each", study::AxisRule::kEach},
                                            {"worst", study::AxisRule::kWorst},
                                            {"mean", study::AxisRule::kMean}});
  const auto [begin, end] = horizon;
  if (!(begin > 0.0 && begin <= end && std::isfinite(end)))
    throw Failure("horizon: expected a range of times (s), such as (0.1, 10)");
  if (step && !(*step > 0.0 && std::isfinite(*step)))
    throw Failure("step: expected a time above 0 s");
  options.conservative = conservative;
  options.horizon = {begin, end};
  options.step = step;
  const study::ExportSource origin{source, study::sha256(fits)};
  if (const auto array = study::parse_array(fits))
    return value_of(study::export_array(*array, *consumer, origin));
  const auto chosen = value_of(study::chosen_fits(value_of(study::parse_fits(fits)), "", {}));
  return value_of(
      study::export_noise(value_of(study::imu_noise(chosen)), *consumer, origin, options));
}

}  // namespace imunoise::python
