#pragma once

// Where the stamps of evenly sampled data leave their pace for good.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "recording/import/preflight/clock.h"

namespace imunoise::recording {

/// Sample `at` and all after it are later (or earlier) than those before say.
struct Leap {
  std::size_t at = 0;
  double seconds = 0.0;  ///< beyond one period; negative: time goes back
};

/// Samples that come evenly, but at another pace than most of the file.
struct OtherPace {
  std::size_t begin = 0;
  std::size_t end = 0;
  double period = 0.0;  ///< s
};

/// A gap lasts: the median lateness of 8 samples and the mean of 64 differ by more than half a
/// period from those before, or nearly all stamps are even and one step is longer. Bursts of a bus
/// and single late stamps do not.
struct Pace {
  double period = 0.0;             ///< s, of the samples between leaps
  double jitter = 0.0;             ///< rms departure of single stamps, in periods
  double scatter = 0.0;            ///< s, the largest departure of a step between leaps
  double span = 0.0;               ///< s, of all stretches between leaps
  std::vector<Leap> leaps;         ///< rising `at`
  std::vector<OtherPace> others;   ///< rising; nothing else here counts their rows
  std::vector<std::size_t> twice;  ///< rows that repeat the row before, stamp included
  std::size_t backwards = 0;       ///< stamps before the one before, where the pace goes on
};

/// Rows that were logged twice: nearly all of those that have the time of the row before have its
/// values, too. None where stamps are coarse, so that few of them do. `same(i)`: row i has the
/// values of row i - 1.
std::vector<std::size_t> logged_twice(const Clock& clock,
                                      const std::function<bool(std::size_t)>& same);

/// What is left out, and why.
std::string words_of(const OtherPace& one, const Clock& clock, double period);

Pace pace_of(const Clock& clock, const std::function<bool(std::size_t)>& same);

}  // namespace imunoise::recording
