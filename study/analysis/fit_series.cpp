#include "study/analysis/fit_series.h"

#include "study/analysis/prepare.h"

namespace imunoise::study {

Result<v1::FitReport> fit_series(const Series& series, const FitOptions& options,
                                 const Progress& progress) {
  const Result<Prepared> prepared = prepare(series, options.model ? *options.model : kDefaultModel,
                                            options.measure, progress.part(0.0, 0.6));
  if (!prepared) return tl::unexpected(prepared.error());
  const auto& [model, measured] = *prepared;
  const Progress fitting = progress.part(0.6, 0.9);
  const Fit fit =
      options.estimator == Estimator::kMuGmwm
          ? infer(mugmwm(model, measured, options.weighting, fitting), measured, options.confidence)
          : infer(agmwm(model, measured, options.weighting, fitting), measured, options.confidence);
  if (progress.stopped()) return fail("stopped");
  v1::FitReport out = fit_report(fit, series, measured);
  out.set_default_model(!options.model);
  out.set_estimator(options.estimator == Estimator::kAGmwm ? "AGMWM"
                    : series.replicates.size() > 1         ? "MuGMWM"
                                                           : "GMWM");
  if (!options.model) out.add_notes(default_model_note("was fitted"));
  progress.report(1.0);
  return out;
}

}  // namespace imunoise::study
