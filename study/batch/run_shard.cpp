#include "study/batch/run_shard.h"

#include <fmt/format.h>

#include "study/analysis/fit_series.h"
#include "study/batch/batch_plan.h"
#include "study/batch/tasks.h"

namespace imunoise::study {
namespace {

Result<void> calibrate_all(const recording::FileSystem& files, const v1::CalibrationTask& task,
                           std::int64_t now_ns, const Progress& progress, v1::ShardResult& to) {
  const CalibrateOptions options = calibrate_options(task.settings(), now_ns);
  const double count = task.recordings_size();
  for (int i = 0; i < task.recordings_size(); ++i) {
    auto calibration =
        calibrate(files, task.recordings(i), options, progress.part(i / count, (i + 1) / count));
    if (!calibration) return tl::unexpected(calibration.error());
    v1::BatchedCalibration& one = *to.add_calibrations();
    one.set_recording(task.recordings(i));
    *one.mutable_calibration() = std::move(*calibration);
  }
  return {};
}

// Simulates set number `set` and fits it.
Result<v1::FitReport> fit_set(const v1::SimulationTask& task, std::uint32_t set,
                              const Progress& progress) {
  const auto truth = simulation_of(task, set);
  if (!truth) return tl::unexpected(truth.error());
  std::vector<std::vector<double>> values;
  Series series;
  series.channel = "x";
  for (std::uint32_t k = 0; k < task.replicates(); ++k) {
    values.push_back(truth->replicate(k).channel);
    series.names.push_back(fmt::format("{}", k + 1));
    series.replicates.emplace_back(std::span<const double>(values.back()), Hertz{task.rate_hz()});
  }
  FitOptions options;
  options.model = task.fit();
  options.confidence = task.confidence();
  return fit_series(series, options, progress);
}

v1::SimulatedFit outcome_of(const v1::FitReport& fit, std::uint32_t set) {
  v1::SimulatedFit out;
  out.set_set(set);
  out.set_termination(fit.termination());
  if (fit.has_p_value()) out.set_p_value(fit.p_value());
  *out.mutable_terms() = fit.terms();
  for (v1::Term& term : *out.mutable_terms()) term.clear_variance();
  return out;
}

Result<void> simulate_all(const v1::SimulationTask& task, const Progress& progress,
                          v1::ShardResult& to) {
  const double count = task.sets();
  for (std::uint32_t i = 0; i < task.sets(); ++i) {
    const std::uint32_t set = task.first_set() + i;
    const auto fit = fit_set(task, set, progress.part(i / count, (i + 1) / count));
    if (!fit) return fail(fmt::format("set {}: {}", set, fit.error().message));
    *to.add_fits() = outcome_of(*fit, set);
  }
  return {};
}

}  // namespace

Result<v1::ShardResult> run_shard(const recording::FileSystem& files, const v1::BatchShard& shard,
                                  std::int64_t now_ns, const Progress& progress) {
  v1::ShardResult out;
  out.set_version(kBatchVersion);
  out.set_shard(shard.number());
  const auto done = shard.has_simulate()
                        ? simulate_all(shard.simulate(), progress, out)
                        : calibrate_all(files, shard.calibrate(), now_ns, progress, out);
  if (!done) return tl::unexpected(done.error());
  return out;
}

}  // namespace imunoise::study
