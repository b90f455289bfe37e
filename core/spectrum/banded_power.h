#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "core/signal/signal.h"
#include "core/support/frequency.h"
#include "core/support/units.h"

namespace imunoise {

/// The power of a signal over frequency: squares of its cosine_transform(), averaged in bands.
struct BandedPower {
  Frequencies frequency;  ///< of each band, cycles per sample
  Eigen::ArrayXd count;   ///< coefficients in the band: degrees of freedom of its power
  Eigen::ArrayXd power;   ///< mean square, unit²: two-sided spectrum in unit² per cycle/sample
  Eigen::ArrayXd ramp_cross;  ///< mean product with the transform of a ramp of slope 1 per sample
  Eigen::ArrayXd ramp_power;  ///< mean square of that ramp's transform
  std::size_t samples = 0;    ///< transformed: quick_length() of the signal's size
  Hertz rate;
};

/// Bands of n samples without a signal: power and ramp_cross are zero.
BandedPower bands_of(std::size_t n, Hertz rate);

/// The same in wider bands: the first 64 coefficients alone, a band above about 1/64 of its
/// frequency wide. Spectra that follow a power of frequency are straight over that to 2e-4.
BandedPower in_wider_bands(const BandedPower& fine);

/// Power of the first quick_length() samples of a signal of at least kFewestSamples.
BandedPower banded_power(const Signal& signal);

}  // namespace imunoise
