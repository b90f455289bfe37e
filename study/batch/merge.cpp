#include "study/batch/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/effects/parse_full_model.h"
#include "study/batch/batch_folder.h"
#include "study/batch/batch_plan.h"
#include "study/calibration/calibration_file.h"
#include "study/report/json.h"

namespace imunoise::study {
namespace {

constexpr double kRejection = 0.05;

// The true parameters in the order of a fit's, when it has the same terms.
std::optional<std::vector<double>> true_values(const v1::SimulationTask& task) {
  const auto truth = parse_full_model(task.model(), Hertz{task.rate_hz()});
  const auto fitted = parse_full_model(task.fit(), Hertz{task.rate_hz()});
  if (!truth || !fitted) return std::nullopt;
  const Model one = sorted(truth->noise);
  const Model other = sorted(fitted->noise);
  if (one.terms.size() != other.terms.size()) return std::nullopt;
  std::vector<double> out;
  for (std::size_t i = 0; i < one.terms.size(); ++i) {
    const Process& process = one.terms[i].process;
    const Process& beside = other.terms[i].process;
    if (process.index() != beside.index() || structure(process) != structure(beside))
      return std::nullopt;
    for (const double value : values(process)) out.push_back(value);
  }
  return out;
}

// What the fits say of one parameter.
class Tally {
 public:
  void add(const v1::Parameter& estimate, std::optional<double> truth) {
    if (truth && estimate.has_lower() && estimate.has_upper()) {
      ++intervals_;
      if (estimate.lower() <= *truth && *truth <= estimate.upper()) ++covering_;
    }
    if (estimate.observability() != v1::observed && estimate.observability() != v1::given) return;
    ++seen_;
    sum_ += estimate.value();
    squares_ += estimate.value() * estimate.value();
  }
  void tell(v1::SimulatedParameter& to) const {
    to.set_seen(seen_);
    if (seen_ > 0) to.set_mean(sum_ / seen_);
    if (seen_ > 1) {
      const double variance = (squares_ - sum_ * sum_ / seen_) / (seen_ - 1);
      to.set_deviation(std::sqrt(std::max(variance, 0.0)));
    }
    if (intervals_ > 0) to.set_covered(static_cast<double>(covering_) / intervals_);
  }

 private:
  std::uint32_t seen_ = 0;
  std::uint32_t intervals_ = 0;
  std::uint32_t covering_ = 0;
  double sum_ = 0.0;
  double squares_ = 0.0;
};

void add_parameters(const std::optional<std::vector<double>>& truth, v1::SimulationSummary& to) {
  if (to.fits().empty()) return;
  std::size_t number = 0;
  for (int t = 0; t < to.fits(0).terms_size(); ++t) {
    for (int p = 0; p < to.fits(0).terms(t).parameters_size(); ++p, ++number) {
      v1::SimulatedParameter& out = *to.add_parameters();
      out.set_term(to.fits(0).terms(t).name());
      out.set_name(to.fits(0).terms(t).parameters(p).name());
      std::optional<double> true_value;
      if (truth) true_value = truth->at(number);
      if (true_value) out.set_truth(*true_value);
      Tally tally;
      for (const v1::SimulatedFit& fit : to.fits())
        tally.add(fit.terms(t).parameters(p), true_value);
      tally.tell(out);
    }
  }
}

Result<std::vector<v1::ShardResult>> all_results(const recording::FileSystem& files,
                                                 const std::filesystem::path& folder) {
  const auto status = batch_status(files, folder);
  if (!status) return tl::unexpected(status.error());
  if (!status->open().empty()) {
    return fail(fmt::format("{}: {} of {} shards have no result; run imunoise batch run",
                            folder.string(), status->open_size(), status->shards()));
  }
  std::vector<v1::ShardResult> out;
  for (std::uint32_t i = 0; i < status->shards(); ++i) {
    auto result = read_result(files, folder, i);
    if (!result) return tl::unexpected(result.error());
    out.push_back(std::move(*result));
  }
  return out;
}

}  // namespace

v1::SimulationSummary summarise(const v1::SimulationTask& task,
                                const std::vector<v1::ShardResult>& results) {
  v1::SimulationSummary out;
  *out.mutable_task() = task;
  for (const v1::ShardResult& result : results) {
    for (const v1::SimulatedFit& fit : result.fits()) {
      out.set_tested(out.tested() + (fit.has_p_value() ? 1 : 0));
      out.set_rejected(out.rejected() + (fit.has_p_value() && fit.p_value() < kRejection ? 1 : 0));
      *out.add_fits() = fit;
    }
  }
  add_parameters(true_values(task), out);
  return out;
}

Result<v1::BatchReport> merge_batch(recording::FileSystem& files,
                                    const std::filesystem::path& folder) {
  const auto batch = read_batch(files, folder);
  if (!batch) return tl::unexpected(batch.error());
  const auto results = all_results(files, folder);
  if (!results) return tl::unexpected(results.error());
  v1::BatchReport out;
  out.set_version(kBatchVersion);
  if (batch->has_simulate()) *out.mutable_simulation() = summarise(batch->simulate(), *results);
  for (const v1::ShardResult& result : *results) {
    for (const v1::BatchedCalibration& one : result.calibrations()) {
      auto written = write_calibration(files, one.recording(), one.calibration());
      if (!written) return tl::unexpected(written.error());
      v1::CalibratedRecording& told = *out.add_calibrations();
      told.set_recording(one.recording());
      told.set_summary(one.calibration().summary());
    }
  }
  auto written = recording::replace_file(files, folder / kMergedName, report::to_json(out));
  if (!written) return tl::unexpected(written.error());
  return out;
}

}  // namespace imunoise::study
