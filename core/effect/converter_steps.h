#pragma once

#include <limits>

#include "core/effect/subject.h"
#include "core/model/model.h"

namespace imunoise {

/// How far noise hides the steps of a converter.
struct ConverterSteps {
  double step = 0.0;  ///< SI; 0 where samples are not whole steps
  /// Deviation of what changes from one sample to the next, in steps, as if it were white.
  double noise = std::numeric_limits<double>::infinity();

  /// The samples take so few values that their distribution is that of the rounding.
  bool is_coarse() const;
  /// Excess kurtosis that rounding gives to normal innovations of a standard deviation (SI) where
  /// it is not coarse: its error is then uniform and independent of the samples (Widrow & Kollár
  /// 2008, Quantization Noise, ch. 5), with a fourth cumulant of -step⁴/120.
  double excess_kurtosis(double innovation) const;
};

/// Of the replicate that shows them most.
ConverterSteps converter_steps(const Subject& subject);

}  // namespace imunoise
