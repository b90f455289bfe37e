#pragma once

// Reports as a fit would write them, for tests and for looking at: made of the closed forms of the
// processes and seeded noise, with nothing fitted.

#include <string>

#include "imunoise/v1/noise.pb.h"

namespace imunoise::report {

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Six replicates of a gyro at 100 Hz, 1e6 samples each: AR1 + WN + RW + QN, 18 dyadic scales,
/// fits.
v1::FitReport good_gyro();

/// The same, measured 38 % above the model between 20 and 80 s.
v1::FitReport misfit_gyro();

/// The same, with RW at zero: only its upper bound is known.
v1::FitReport bounded_gyro();

/// One recording of an accelerometer: WN + RW.
v1::FitReport accelerometer();

/// Numbers without a unit, two AR1 terms, four scales an octave where half-widths are whole.
v1::FitReport dense_unknown_unit();

/// Names, notes and units that attack HTML, XML and terminals.
v1::FitReport hostile_names();

/// Zero variances, arrays of unequal length, NaN where one may stand.
v1::FitReport broken_arrays();

/// The pooled curve of good_gyro as `wv` prints it.
v1::WaveletVarianceReport measured_gyro();

}  // namespace imunoise::report
