#pragma once

// A fit report as the renderers see it: complete entries only, with NaN where a value is missing.

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "imunoise/v1/diagnosis.pb.h"

namespace imunoise::report {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// Residuals beyond ±kSigmaLimit standard deviations are marked: one in twenty is by chance.
constexpr double kSigmaLimit = 2.0;

/// One scale of the noise budget; kMissing where the report says nothing.
struct ScaleView {
  std::size_t index = 0;       ///< In the message.
  double seconds = kMissing;   ///< Averaging time, in s.
  double measured = kMissing;  ///< In unit².
  double lower = kMissing;     ///< In unit².
  double upper = kMissing;     ///< In unit².
  double model = kMissing;     ///< In unit².
  double ghost = kMissing;     ///< Total of a model that might be, in unit².
  double residual = kMissing;  ///< In standard deviations.
  double ghost_residual =
      kMissing;  ///< What the model that might be leaves, in standard deviations.
  bool tested = false;
  std::vector<double> terms;  ///< One a term, in unit².

  /// A residual larger than chance on a scale that takes part in the test.
  bool outside() const;
  /// A term's part of the model's variance; kMissing where the model is zero.
  double share(std::size_t term) const;
};

struct ReplicateView {
  std::string name;
  std::uint32_t samples = 0;
  std::vector<ScaleView> scales;  ///< seconds, measured and residual only.
};

struct BudgetView {
  std::vector<ScaleView> scales;   ///< In order of averaging time.
  std::vector<std::string> terms;  ///< Names; terms of one name are numbered: "AR1 (1)", "AR1 (2)".
  std::vector<ReplicateView> replicates;
};

BudgetView budget_view(const v1::FitReport& report);
/// The budget alone, without terms and replicates.
BudgetView budget_view(const v1::NoiseBudget& budget);
/// The budget of a rung, with its terms and replicates.
BudgetView budget_view(const v1::RungPicture& picture);
/// A measurement without a model.
BudgetView budget_view(const v1::WaveletVarianceReport& report);

/// In order of averaging time; scales whose time is no time are left out.
std::vector<ReplicateView> replicate_views(
    const google::protobuf::RepeatedPtrField<v1::ReplicateResidual>& replicates);

/// Numbers of ADEV: Allan deviation = √(2ν)·factor, in `unit`, at half of the averaging time of ν.
struct AllanUnit {
  double factor = 1.0;
  std::string unit;
  double deviation(double variance) const;  ///< From a wavelet variance in unit².
  double variance(double deviation) const;  ///< Back.
};

/// Datasheet unit of a channel's Allan deviation (°/h, µg); the unit itself where none is
/// customary, or where SI units are wanted.
AllanUnit allan_unit(const std::string& unit, bool si = false);

/// The same with Allan deviations over their averaging times in place of wavelet variances.
BudgetView as_allan(BudgetView view, const AllanUnit& unit);

/// "(rad/s)²", "T²"; "unit²" when the unit is unknown.
std::string squared(const std::string& unit);

}  // namespace imunoise::report
