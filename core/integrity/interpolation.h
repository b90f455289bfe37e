#pragma once

#include <cstddef>
#include <span>

namespace imunoise {

/// Samples that are looked at.
inline constexpr std::size_t kMostInterpolated = std::size_t{1} << 17U;

/// The beat of two sampling rates, cycles per sample, in a series that was resampled by linear
/// interpolation between evenly spaced samples of nearly white noise; 0 where none shows. A sample
/// halfway between two originals has half of their power: the power of first and second differences
/// repeats with the beat, in forms that the ratio of the rates determines.
double interpolation_beat(std::span<const double> x);

}  // namespace imunoise
