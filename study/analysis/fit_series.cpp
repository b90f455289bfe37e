#include "study/analysis/fit_series.h"

#include <fmt/format.h>

#include <algorithm>

namespace imunoise::study {
namespace {

std::size_t free_parameters(const Model& model) {
  std::size_t out = 0;
  for (const Term& term : model.terms) {
    out += static_cast<std::size_t>(std::count(term.given.begin(), term.given.end(), false));
  }
  return out;
}

}  // namespace

Result<v1::FitReport> fit_series(const Series& series, const FitOptions& options,
                                 const Progress& progress) {
  const Result<Model> model =
      parse_model(options.model ? *options.model : kDefaultModel, series.replicates.front().rate());
  if (!model) return tl::unexpected(model.error());
  const Result<std::vector<WaveletVariance>> measured =
      measure(series, options.measure, progress.part(0.0, 0.6));
  if (!measured) return tl::unexpected(measured.error());
  std::size_t scales = 0;
  for (const WaveletVariance& wv : *measured) scales = std::max(scales, wv.scales.size());
  if (free_parameters(*model) > scales) {
    return fail(fmt::format(
        "model: {} has {} free parameters, but the recording has only {} scales; take a "
        "smaller model, record longer, or ask for more scales an octave",
        print(*model), free_parameters(*model), scales));
  }
  const Progress fitting = progress.part(0.6, 0.9);
  const Fit fit = options.estimator == Estimator::kMuGmwm
                      ? infer(mugmwm(*model, *measured, options.weighting, fitting), *measured,
                              options.measure.confidence)
                      : infer(agmwm(*model, *measured, options.weighting, fitting), *measured,
                              options.measure.confidence);
  if (progress.stopped()) return fail("stopped");
  v1::FitReport out = fit_report(fit, series, *measured);
  out.set_default_model(!options.model);
  out.set_estimator(options.estimator == Estimator::kAGmwm ? "AGMWM"
                    : series.replicates.size() > 1         ? "MuGMWM"
                                                           : "GMWM");
  if (!options.model) {
    out.add_notes(
        fmt::format("No model was named: {} was fitted. Choose one with --model.", kDefaultModel));
  }
  progress.report(1.0);
  return out;
}

}  // namespace imunoise::study
