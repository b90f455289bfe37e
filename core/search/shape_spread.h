#pragma once

#include <cmath>

#include "core/regression/modulation.h"

namespace imunoise {

/// How the spectra of replicates differ in shape: octave by octave, against how much the parts of
/// each replicate differ.
struct ShapeSpread {
  /// How much more replicates whose parts differ so much differ by chance than under steady noise,
  /// in the octaves in which they differ.
  double inflation = 1.0;
  double dof = INFINITY;  ///< that this is known with; infinite where parts differ by chance only
};

/// By an analysis of variance of the logarithms of powers of octaves, less that of all frequencies,
/// in the quarters of each replicate. Octaves of less than 16 coefficients of a quarter are left
/// out.
ShapeSpread shape_spread(const Innovations& innovations);

/// Nats that a level of its own for each replicate gains over one for all.
double level_gain(const Innovations& innovations);

}  // namespace imunoise
