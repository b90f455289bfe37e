#include "study/analysis/arrays/fault_series.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/faults/fault_detector.h"
#include "study/analysis/arrays/array_series.h"
#include "study/analysis/arrays/array_setup.h"
#include "study/analysis/arrays/fault_traces.h"
#include "study/analysis/prepare.h"
#include "study/words/number.h"

namespace imunoise::study {
namespace {

constexpr int kMostTraced = 4;  // replicates

std::string_view word_of(FaultKind kind) {
  switch (kind) {
    case FaultKind::kStep:
      return "step";
    case FaultKind::kNoisy:
      return "noisy";
    case FaultKind::kStuck:
      break;
  }
  return "stuck";
}

Result<void> check_training(const std::vector<Series>& sensors,
                            const std::vector<Series>& training) {
  const auto named = [](const Series& a, const Series& b) { return a.channel == b.channel; };
  if (!std::equal(sensors.begin(), sensors.end(), training.begin(), training.end(), named)) {
    return fail(
        "train: the recordings to train on have other channels than those to search; choose the "
        "same with --channel");
  }
  const double rate = sensors.front().replicates.front().rate().value;
  const double other = training.front().replicates.front().rate().value;
  if (rate != other) {
    return fail(fmt::format(
        "train: {} has {:g} Hz, {} has {:g} Hz: a model knows the noise of one rate only",
        training.front().names.front(), other, sensors.front().names.front(), rate));
  }
  return {};
}

void add_fault(const Fault& from, const std::vector<Series>& sensors, std::size_t replicate,
               v1::FaultReport& out) {
  v1::SensorFault& to = *out.add_faults();
  const double period = 1.0 / out.rate_hz();
  to.set_kind(std::string(word_of(from.kind)));
  for (const Eigen::Index sensor : from.sensors) {
    to.add_sensors(sensors[static_cast<std::size_t>(sensor)].channel);
  }
  to.set_replicate(sensors.front().names[replicate]);
  to.set_onset_s(static_cast<double>(from.onset) * period);
  to.set_detected_s(static_cast<double>(from.detected) * period);
  to.set_delay_s(static_cast<double>(from.detected - std::min(from.onset, from.detected)) * period);
  if (from.end > 0) to.set_end_s(static_cast<double>(from.end) * period);
  to.set_size(from.size);
  if (from.kind == FaultKind::kStep) to.set_size_error(from.size_error);
  to.set_evidence(from.gain);
}

// Searches one replicate; false when the caller stopped it.
bool search(FaultDetector& detector, const std::vector<Series>& sensors, std::size_t replicate,
            v1::FaultReport& out, const Progress& progress) {
  constexpr std::size_t kAsk = 1 << 14;  // readings between questions whether to stop
  const std::size_t samples = sensors.front().replicates[replicate].size();
  Eigen::VectorXd reading(static_cast<Eigen::Index>(sensors.size()));
  detector.restart();
  for (std::size_t t = 0; t < samples; ++t) {
    if (t % kAsk == 0) {
      progress.report(static_cast<double>(t) / static_cast<double>(samples));
      if (progress.stopped()) return false;
    }
    for (std::size_t i = 0; i < sensors.size(); ++i) {
      reading(static_cast<Eigen::Index>(i)) = sensors[i].replicates[replicate].value(t);
    }
    if (const auto fault = detector.feed(reading)) add_fault(*fault, sensors, replicate, out);
  }
  if (const auto fault = detector.finish()) add_fault(*fault, sensors, replicate, out);
  return true;
}

std::string summary_of(const v1::FaultReport& report) {
  if (report.faults_size() == 0 && !(report.watched_s() > 0.0))
    return fmt::format(
        "Too short to search: the first {} s of a replicate only show the levels of its sensors.",
        report::brief(report.warm_up_s()));
  const double hours = report.watched_s() / 3600.0;
  const std::string chance =
      fmt::format("In {} h, {} false alarms are to be expected.", report::brief(hours),
                  report::brief(hours * report.false_alarms_per_hour(), 2));
  if (report.faults_size() == 0) return "No sensor steps, sticks or grows noisy. " + chance;
  std::string out = report.faults_size() == 1
                        ? "One fault was found."
                        : fmt::format("{} faults were found.", report.faults_size());
  return out + " " + chance;
}

// `trained`: readings of each sensor.
void add_notes(const v1::FaultReport& report, const FaultDetector& detector,
               const FaultSeriesOptions& options, std::size_t trained,
               std::vector<std::string>& notes) {
  constexpr std::size_t kFewReadings = 50'000;
  if (!options.model) notes.push_back(default_model_note("was fitted", kDefaultArrayModel));
  if (!report.trained_elsewhere()) {
    notes.push_back(
        "The model was fitted to the recordings that were searched: what is wrong in much of them "
        "counts as noise. Fit it to recordings known to be good (--train) where there are some.");
  }
  if (trained < kFewReadings) {
    notes.push_back(fmt::format(
        "The model was fitted to {} readings, which show slow noise only roughly. imunoise "
        "therefore finds small faults late or not at all. Train on {} readings or more.",
        report::count(trained, report::Digits::kTypeset),
        report::count(kFewReadings, report::Digits::kTypeset)));
  }
  for (const v1::StuckRule& rule : report.stuck_rules()) {
    if (rule.has_repetitions()) continue;
    notes.push_back(fmt::format(
        "{} shows less noise than its resolution: that it sticks cannot be told from that it is "
        "quiet.",
        rule.sensor()));
  }
  if (report.sensors_size() == 2) {
    notes.push_back(
        "With two sensors a step shows that they disagree, not which of them is wrong: a third "
        "would tell.");
  }
  if (detector.watched().empty()) {
    notes.push_back(
        "Fewer than two sensors were left: nothing was watched for after the last fault.");
  }
}

}  // namespace

Result<v1::FaultReport> fault_series(const std::vector<Series>& sensors, const Training& training,
                                     const FaultSeriesOptions& options, const Progress& progress) {
  if (!(options.false_alarms_per_hour > 0.0)) {
    return fail("false alarms: the rate that is allowed must be above zero");
  }
  const std::vector<Series>& good = training.sensors;
  if (auto same = check_training(sensors, good); !same) return tl::unexpected(same.error());
  const Result<ArraySetup> setup =
      array_setup(good, options.model ? *options.model : kDefaultArrayModel, options.groups,
                  options.per_octave, progress.part(0.0, 0.3));
  if (!setup) return tl::unexpected(setup.error());
  const ArrayFit fit = fit_array(setup->model, setup->layout, setup->measured,
                                 {.weighting = options.weighting}, progress.part(0.3, 0.5));
  if (progress.stopped()) return fail("stopped");
  if (!parity_is_noisy(fit.model)) {
    return fail(fmt::format(
        "model: by {} some sensors differ by a constant only, so that any difference were a fault; "
        "give each sensor independent noise, such as WN",
        print(setup->model)));
  }

  FaultOptions how;
  how.false_alarms_per_hour = options.false_alarms_per_hour;
  how.longest = 0;
  for (const Signal& one : good.front().replicates) how.longest = std::max(how.longest, one.size());
  for (const Series& one : good) how.resolution.push_back(resolution_of(one));
  const Hertz rate = sensors.front().replicates.front().rate();
  std::size_t trained = 0;
  for (const Signal& one : good.front().replicates) trained += one.size();
  how.doubt = ModelDoubt(fit, static_cast<double>(trained));
  FaultDetector detector(fit.model, rate, how);

  v1::FaultReport out;
  out.set_unit(std::string(si_symbol(sensors.front().replicates.front().quantity())));
  out.set_rate_hz(rate.value);
  for (const Series& one : sensors) out.add_sensors(one.channel);
  for (const std::string& name : sensors.front().names) out.add_replicates(name);
  out.set_model(print(setup->model));
  out.set_trained_on(static_cast<std::uint32_t>(good.front().replicates.size()));
  out.set_trained_elsewhere(training.elsewhere);
  out.set_false_alarms_per_hour(options.false_alarms_per_hour);
  out.set_warm_up_s(static_cast<double>(FaultDetector::kWarmUp) / rate.value);
  const std::vector<std::size_t> repetitions = detector.repetitions();
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    v1::StuckRule& rule = *out.add_stuck_rules();
    rule.set_sensor(sensors[i].channel);
    rule.set_resolution(how.resolution[i]);
    if (repetitions[i] > 0) rule.set_repetitions(static_cast<std::uint32_t>(repetitions[i]));
  }
  const std::size_t count = sensors.front().replicates.size();
  double watched = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const auto share = [&](std::size_t i) {
      return 0.5 + 0.5 * static_cast<double>(i) / static_cast<double>(count);
    };
    const int before = out.faults_size();
    if (!search(detector, sensors, k, out, progress.part(share(k), share(k + 1)))) {
      return fail("stopped");
    }
    const std::size_t samples = sensors.front().replicates[k].size();
    if (samples > FaultDetector::kWarmUp)
      watched += static_cast<double>(samples - FaultDetector::kWarmUp) / rate.value;
    const bool room = out.traces_size() < kMostTraced * out.sensors_size();
    if (out.faults_size() > before && room) add_traces(sensors, k, out);
  }
  out.set_watched_s(watched);
  out.set_summary(summary_of(out));
  std::vector<std::string> notes;
  add_notes(out, detector, options, trained, notes);
  for (std::string& note : notes) out.add_notes(std::move(note));
  return out;
}

}  // namespace imunoise::study
