#pragma once

#include <optional>
#include <span>

namespace imunoise {

/// What one calibration says of a parameter, on a scale where its error is about normal: the
/// logarithm of a coefficient.
struct DatedEstimate {
  double time = 0.0;  ///< any unit
  double value = 0.0;
  double variance = 0.0;  ///< of the error of `value`, known from the calibration itself
};

struct ChangeTest {
  double change = 0.0;   ///< on the scale of the values
  double p_value = 1.0;  ///< two-sided
};

/// Where the next estimate lies unless something changed.
struct ExpectedRange {
  double centre = 0.0;
  double lower = 0.0;
  double upper = 0.0;
};

/// The least history that tests need: fewer say nothing of how calibrations scatter.
inline constexpr std::size_t kLeastHistory = 3;

/// Is the last estimate compatible with those before it? Estimates scatter as N(µ, variance + τ²),
/// τ what a device differs between recordings by itself, unknown. Generalised p-value: Cochran's
/// Q(τ²) = Σ(x - x̄)²/(variance + τ²) of the history is χ² with n - 1 degrees of freedom, which
/// gives τ² a fiducial distribution; the chance of a change this large is averaged over it (Iyer,
/// Wang and Mathew 2004). It is Student's test where τ² is large and is never below the test that
/// knows τ² = 0. `change` is the last estimate less the history's mean. Nothing for a history
/// shorter than kLeastHistory. Precondition: positive variances.
std::optional<ChangeTest> test_newest(std::span<const DatedEstimate> estimates);

/// Do the estimates follow a straight line over time? The same p-value for the slope of all of
/// them; `change` is that of the line from the first time to the last. Nothing for fewer than
/// kLeastHistory + 1 estimates, or where all times are the same.
std::optional<ChangeTest> test_trend(std::span<const DatedEstimate> estimates);

/// The values whose p-value by test_newest() is above `level`, for a next estimate of this
/// variance.
std::optional<ExpectedRange> expected_next(std::span<const DatedEstimate> history, double variance,
                                           double level);

}  // namespace imunoise
