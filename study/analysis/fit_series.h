#pragma once

#include <optional>
#include <string>

#include "core/inference/fit.h"
#include "study/analysis/measure.h"

namespace imunoise::study {

enum class Estimator {
  kMuGmwm,   ///< one model for all replicates (GMWM when there is only one)
  kAGmwm,    ///< the average of one model a replicate
  kWhittle,  ///< MuGMWM, carried on to the maximum of Whittle's likelihood
};

struct FitOptions {
  std::optional<std::string> model;  ///< in the grammar; unset: kDefaultModel
  Estimator estimator = Estimator::kMuGmwm;
  Weighting weighting = Weighting::kFull;
  bool compare = true;  ///< parameters of 3 to 50 replicates with each other
  MeasureOptions measure;
  double confidence = 0.95;  ///< of the intervals of the fit; the estimate does not depend on it
};

/// Measures the replicates, fits the model and says everything about it. Error: a model that cannot
/// be read (with the place), more free parameters than moments, replicates too short for the
/// likelihood, or the caller stopped it.
Result<v1::FitReport> fit_series(const Series& series, const FitOptions& options,
                                 const Progress& progress = {});

/// A fit as a message, all but its model (add_effects()). `measured` are the replicates it was made
/// from.
v1::FitReport fit_report(const Fit& fit, const Series& series,
                         const std::vector<WaveletVariance>& measured);

}  // namespace imunoise::study
