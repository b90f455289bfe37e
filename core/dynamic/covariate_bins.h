#pragma once

// Where a covariate stays long enough for noise to be measured.

#include <cstddef>
#include <span>
#include <vector>

namespace imunoise {

/// Consecutive samples of one recording whose covariate lies in one bin.
struct Run {
  std::size_t recording;
  std::size_t begin;
  std::size_t count;
};

/// What was recorded while the covariate was between lower and upper.
struct Bin {
  double lower = 0.0;
  double upper = 0.0;
  double mean = 0.0;        ///< of the covariate over the runs' samples
  std::size_t samples = 0;  ///< of all runs
  std::vector<Run> runs;
};

struct BinOptions {
  /// Values near which the covariate stays. The bin about each is as wide as the covariate scatters
  /// there.
  std::vector<double> values{};
  /// Or this many bins with as many samples each, where the covariate's own noise does not end a
  /// run. When neither is given, plateaus are looked for,
  /// and if there are not at least two, kCustomaryBins bins are made.
  std::size_t count = 0;
  std::size_t settle = 0;  ///< samples left out at the start of every run
};

inline constexpr std::size_t kCustomaryBins = 8;
/// Shorter runs are left out: they show fewer than three scales.
inline constexpr std::size_t kLeastRun = 16;

struct Bins {
  std::vector<Bin> bins;     ///< by mean, ascending; none is empty
  std::size_t left_out = 0;  ///< samples between bins, settling, or in runs that are too short
  bool plateaus = false;     ///< the bins are places where the covariate stayed
};

/// Sorts recordings (one vector of covariate values each, finite) into bins. A run never crosses
/// from one recording to the next. Deterministic; thread-safe.
Bins bin_by_covariate(std::span<const std::vector<double>> recordings, const BinOptions& options);

}  // namespace imunoise
