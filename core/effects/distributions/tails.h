#pragma once

// Do all innovations have heavy tails, or are a few of them disturbed?

#include "core/effects/distributions/student.h"

namespace imunoise {

/// Student's distribution against a mixture of two normal ones (Tukey's contaminated distribution)
/// with at most a fiftieth in the wider one, both of most likelihood.
struct TailComparison {
  double student = 0.0;  ///< nats that it gains over a normal distribution
  double mixture = 0.0;
  double error = 0.0;  ///< standard deviation of the difference (Vuong 1989, Econometrica 57:307)

  /// The other one explains more, beyond chance, or far more.
  bool rules_out_student() const { return ruled_out(student, mixture); }
  bool rules_out_mixture() const { return ruled_out(mixture, student); }

 private:
  bool ruled_out(double one, double other) const {
    constexpr double kClear = 3.0;         // nats
    constexpr double kBeyondChance = 3.0;  // standard deviations
    constexpr double kFarLess = 0.6;
    if (other - one < kClear) return false;
    return other - one > kBeyondChance * error || one < kFarLess * other;
  }
};
TailComparison compare_tails(const SizeCounts& sizes);

}  // namespace imunoise
