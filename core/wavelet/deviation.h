#pragma once

// Allan and Hadamard variances as the clock community defines them (NIST SP 1065), overlapping.

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "core/signal/signal.h"

namespace imunoise {

enum class DeviationKind {
  kAllan,  ///< second differences of the integral: ½⟨(ȳ₂ - ȳ₁)²⟩, half of the Haar variance's basis
  kHadamard,  ///< third differences: ⅙⟨(ȳ₃ - 2ȳ₂ + ȳ₁)²⟩, blind to a ramp
};

/// Allan deviation of the floor of flicker noise over its coefficient B: √(2 ln2/π).
inline constexpr double kFlickerFloor = 0.664;

/// Averaging factors that tables print: 1, 2, 4, 10, 20, 40, 100, ... samples, as long as the
/// deviation has at least one value.
std::vector<std::size_t> customary_factors(DeviationKind kind, std::size_t samples);

/// How many differences of m samples there are: T - 2m + 1 or T - 3m + 1; 0 where there is none.
std::size_t difference_count(DeviationKind kind, std::size_t samples, std::size_t m);

/// Overlapping variance at each averaging factor, in the square of the signal's SI unit.
/// Precondition: each has a difference. Thread-safe.
Eigen::ArrayXd deviation_variance(DeviationKind kind, const Signal& signal,
                                  const std::vector<std::size_t>& factors);

/// Power-law noises, by the slope of the variance over τ: -2, -1, +1.
enum class NoiseType { kQuantisation, kWhite, kRandomWalk };
/// The law nearest to the slope of log variance over log τ; halfway, where flicker lies, the one
/// with fewer degrees of freedom.
NoiseType nearest_law(double slope);

/// Equivalent degrees of freedom 2E²/Var of the overlapping estimate from `samples` samples of a
/// Gaussian noise: M²γ(0)² / Σ_s (M - |s|) γ(s)², γ the autocovariance of the differences. To 1 %
/// (the sum takes at least 256 lags a factor, all of them up to m = 256).
double deviation_degrees(DeviationKind kind, NoiseType law, std::size_t samples, std::size_t m);

/// The place of the lowest of a curve of deviations, none of which is zero. A filter removes the
/// noise of the shortest times, where the curve rises to a hump: what lies before that does not
/// count, if the curve then falls three times in a row, clearly. Precondition: there is one.
std::size_t lowest_deviation(std::span<const double> curve);

}  // namespace imunoise
