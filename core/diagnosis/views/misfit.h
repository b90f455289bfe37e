#pragma once

#include <optional>
#include <vector>

#include "core/inference/goodness.h"
#include "core/regression/fitted_model.h"

namespace imunoise {

/// A stretch of frequencies where the data have more or less power than the model.
struct BandMisfit {
  double from = 0.0;   ///< Hz
  double to = 0.0;     ///< Hz
  double ratio = 1.0;  ///< measured power over the model's
  double sigma = 0.0;  ///< normal score of that
  int replicates = 0;  ///< in how many of them it lies on the same side
  double dof = 0.0;    ///< degrees of freedom of the measured power
};

/// A stretch of time in which a replicate's innovations have another variance than the others.
struct TimeMisfit {
  std::size_t replicate = 0;
  double from = 0.0;   ///< s
  double to = 0.0;     ///< s
  double ratio = 1.0;  ///< variance there over 1
  double sigma = 0.0;
};

/// The power of a replicate's innovations, 1 under a true model.
struct ReplicatePower {
  std::size_t replicate = 0;
  double power = 1.0;
  double dof = 0.0;  ///< samples
};

/// How the current model fails, whatever the cause.
struct MisfitReport {
  TestOutcome spectrum;    ///< all half octaves together, less what the parameters can do
  TestOutcome time;        ///< variance of the innovations over 16 stretches a replicate
  TestOutcome kurtosis{};  ///< of the innovations, one degree of freedom
  /// 0 for normal noise that was rounded as these samples; none where few values occur.
  std::optional<double> excess_kurtosis{};
  std::vector<BandMisfit> bands;  ///< half octaves, lowest first
  std::vector<TimeMisfit> times;
  std::vector<ReplicatePower> powers;
  /// The same, however much power each replicate has.
  std::optional<double> excess_within_replicates{};
};
MisfitReport misfit_of(const FittedModel& fitted);

/// The variance of a replicate's innovations over 16 stretches, against the whole of it. `rate` in
/// Hz.
std::vector<TimeMisfit> time_misfits(const VectorRef& white, std::size_t replicate, double rate);

/// Chance that a true model fits as badly as the worst of the three.
double misfit_p_value(const MisfitReport& misfit);

/// Nats that a model without the misfit of the spectrum, or over time, gains on data it was not
/// fitted to: half of χ² less twice its degrees of freedom (Akaike 1974), 0 where a true model fits
/// as badly once in a hundred. A kurtosis is no likelihood ratio, and promises nothing in nats.
double promised_nats(const MisfitReport& misfit);

}  // namespace imunoise
