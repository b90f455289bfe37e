#pragma once

// White noise and a random walk, seen through Kalman's filter.

#include "tests/hidden_effects/generator/recording.h"

namespace imunoise::hidden {

/// A walk that starts anywhere, in white noise; standard deviations, the walk's of an increment.
struct WhiteWalk {
  double white = 1.0;
  double walk = 0.0;
};

/// What a filter knows of the walk, sample by sample.
class WalkFilter {
 public:
  explicit WalkFilter(const WhiteWalk& noise);
  /// Variance of the next sample about the walk as it is known, `more` of it being its own beside
  /// the white noise's.
  double expected(double more = 0.0) const { return variance_ + white_ + more; }
  /// The share of a deviation from it that moves what is known; then the next sample's turn comes.
  double next(double more = 0.0);

 private:
  double white_;
  double walk_;
  double variance_;
};

/// Deviations of samples from what the ones before make likely, in their standard deviations.
Series innovations(const Series& x, const WhiteWalk& noise);

/// Log-likelihood of a series, less ½ ln 2π a sample. `more`: variance of white noise beside it, of
/// each sample; empty for none.
double log_likelihood(const Series& x, const WhiteWalk& noise, const Series& more = {});

}  // namespace imunoise::hidden
