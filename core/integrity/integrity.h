#pragma once

#include <string>
#include <vector>

#include "core/signal/signal.h"

namespace imunoise {

/// A sample that is known to be wrong.
struct WrongSample {
  std::size_t at = 0;
  int beyond = 0;  ///< 1: the truth lies at or above its value, -1: at or below it, 0: anywhere
};

/// A defect of the samples themselves, which every model would be blamed for.
struct Defect {
  std::string effect;     ///< its id in the catalogue
  std::size_t count = 0;  ///< samples concerned
  /// Of them without the defect; of few codes, the change from one sample to the next in steps; of
  /// dropouts, their value; of interpolated samples, their beat in cycles per sample.
  double number = 0.0;
  std::size_t first = 0;   ///< place of the first
  std::size_t places = 1;  ///< stretches that it comes in
  /// The samples, rising, where few of them can be sound; else empty.
  std::vector<WrongSample> wrong{};
};

/// What the values alone can tell: samples that repeat the one before more often than samples far
/// apart are equal, an output that stands still, a pile of samples at an end of the range, codes
/// that never occur among others that do (`count` of them, `expected` samples), a step so coarse
/// that few codes are used, a value far from all others that occurs again and again, and a series
/// interpolated from another rate. Empty where nothing is wrong.
std::vector<Defect> integrity(const Signal& signal);

/// Stretches in which the output stands still longer than noise of its step and size ever does.
struct StuckRun {
  std::size_t first = 0;
  std::size_t count = 0;
};
std::vector<StuckRun> stuck_runs(const Signal& signal);

}  // namespace imunoise
