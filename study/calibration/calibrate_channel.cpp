#include "study/calibration/calibrate_channel.h"

#include <fmt/format.h>

#include "study/analysis/diagnose_series.h"
#include "study/analysis/fit_series.h"
#include "study/analysis/select_model.h"
#include "study/analysis/test_series.h"
#include "study/analysis/vocabulary.h"
#include "study/report/view/verdict.h"

namespace imunoise::study {
namespace {

constexpr int kMostCandidates = 3;

// Keeps what a step made, or why it made nothing.
template <class Report>
bool keep(Result<Report> done, std::string_view step, v1::ChannelCalibration& to,
          Report* (v1::ChannelCalibration::*place)()) {
  if (done) {
    *(to.*place)() = std::move(*done);
  } else {
    add_trouble(step, done.error(), *to.mutable_troubles());
  }
  return done.has_value();
}

Result<v1::WaveletVarianceReport> wavelet(const Series& series, const Progress& progress) {
  const auto measured = measure(series, {}, progress);
  if (!measured) return tl::unexpected(measured.error());
  return wavelet_report(series, *measured);
}

// A calibration is kept for years: the verdict and who may have done it are, not all that was
// tried.
void shorten(v1::DiagnosisReport& report) {
  if (report.candidates_size() > kMostCandidates) {
    report.mutable_candidates()->DeleteSubrange(kMostCandidates,
                                                report.candidates_size() - kMostCandidates);
  }
  report.clear_before();
  report.clear_after();
  report.clear_compared_before();
  report.clear_compared_after();
}

// The model fits each replicate, and no one set of parameters fits them all.
bool only_differ(const v1::StationarityReport& test) {
  return test.heterogeneity().rejected() && test.misfit().degrees_of_freedom() > 0 &&
         !test.misfit().rejected();
}

std::string differing(const v1::StationarityReport& test) {
  return fmt::format(
      "no noise is missing: the model fits every replicate, and its parameters differ between them "
      "({}); look for what changed from one to the next",
      chance_words(test.heterogeneity().p_value()));
}

// Models that may fit where one does not: of the best held-out likelihood with FN, QN or DR, and
// what a diagnosis adds first.
std::vector<std::string> better_models(const Series& series, const std::string& model,
                                       const v1::DiagnosisReport& diagnosis,
                                       const Progress& progress) {
  SelectOptions select;
  select.models = {model};
  select.search_on = true;
  std::vector<std::string> out;
  if (auto chosen = chosen_model(series, select, progress); chosen && *chosen != model)
    out.push_back(*std::move(chosen));
  if (diagnosis.ladder_size() > 1) out.push_back(diagnosis.ladder(1).model());
  return out;
}

// Which term a model lacks that does not fit, and whether it fits with that.
std::string what_is_missing(const Series& series, const std::string& model,
                            const v1::DiagnosisReport& diagnosis, const Progress& progress) {
  std::string first;
  for (const std::string& better :
       better_models(series, model, diagnosis, progress.part(0.0, 0.7))) {
    FitOptions fit;
    fit.model = better;
    fit.compare = false;
    const auto fitted = fit_series(series, fit, progress.part(0.7, 1.0));
    if (!fitted) continue;
    const std::string chance = chance_words(fitted->p_value());
    if (report::verdict(*fitted) != report::Verdict::kFails)
      return fmt::format("{} fits ({})", better, chance);
    if (first.empty())
      first = fmt::format(
          "{} predicts better, but does not fit either ({}); find the missing effect with imunoise "
          "diagnose",
          better, chance);
  }
  return first.empty() ? "neither FN, QN nor DR makes the model fit; find the missing effect with "
                         "imunoise diagnose"
                       : first;
}

}  // namespace

void add_trouble(std::string_view step, const Error& error,
                 google::protobuf::RepeatedPtrField<v1::CalibrationTrouble>& to) {
  if (!to.empty() && to.rbegin()->message() == error.message) return;
  v1::CalibrationTrouble& trouble = *to.Add();
  trouble.set_step(std::string(step));
  trouble.set_message(error.message);
}

v1::ChannelCalibration calibrate_channel(const std::vector<recording::Replicate>& replicates,
                                         std::size_t channel, const CalibrateOptions& options,
                                         const Progress& progress) {
  using Calibration = v1::ChannelCalibration;
  Calibration out;
  const Series series = series_of(replicates, channel);
  keep(wavelet(series, progress.part(0.0, 0.1)), "measure", out, &Calibration::mutable_wavelet);

  std::optional<std::string> model;
  if (options.models.size() == 1) {
    model = options.models.front();
  } else {
    SelectOptions select;
    select.models = options.models;
    if (!options.explain) {
      auto chosen = chosen_model(series, select, progress.part(0.1, 0.3));
      if (chosen)
        model = *std::move(chosen);
      else
        add_trouble("select", chosen.error(), *out.mutable_troubles());
    } else if (keep(select_model(series, select, progress.part(0.1, 0.3)), "select", out,
                    &Calibration::mutable_choice)) {
      model = model_to_use(out.choice()).model();
    }
  }
  FitOptions fit;
  fit.model = model;
  fit.compare = false;  // the test does
  keep(fit_series(series, fit, progress.part(0.3, 0.35)), "fit", out, &Calibration::mutable_fit);
  if (replicates.size() > 1) {
    TestOptions test;
    test.model = model;
    test.bootstrap = options.bootstrap;
    keep(test_series(series, test, progress.part(0.35, 0.55)), "test", out,
         &Calibration::mutable_stationarity);
  }
  if (options.diagnose) {
    DiagnoseOptions diagnose;
    diagnose.model = model;
    if (keep(diagnose_series(replicates, channel, diagnose, progress.part(0.55, 0.9)), "diagnose",
             out, &Calibration::mutable_diagnosis)) {
      shorten(*out.mutable_diagnosis());
    }
  }
  if (options.explain && out.has_fit() && report::verdict(out.fit()) == report::Verdict::kFails) {
    out.set_missing(
        only_differ(out.stationarity())
            ? differing(out.stationarity())
            : what_is_missing(series, out.fit().model(), out.diagnosis(), progress.part(0.9, 1.0)));
  }
  progress.report(1.0);
  return out;
}

}  // namespace imunoise::study
