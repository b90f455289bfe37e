#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/effect/subject.h"

namespace imunoise {

/// The spectrum of a witness, of all its replicates together: bands of a 16th of an octave, each
/// smoothed over those within a quarter of an octave. It tells how much of the witness is a signal
/// beside white noise of the witness's own (Wiener 1949, Extrapolation, Interpolation, and
/// Smoothing of Stationary Time Series).
class WitnessSpectrum {
 public:
  using Index = Eigen::Index;

  /// `cosines`: one cosine_transform() a replicate.
  explicit WitnessSpectrum(const std::vector<SharedVector>& cosines);

  Index bands() const { return power_.size(); }
  /// Where a band begins, cycles per sample.
  double frequency(Index band) const;
  /// Place of the first coefficient of each band in the transform of so many samples, and the end.
  std::vector<Index> edges(Index samples) const;
  /// Share of each band that is signal, from 0 to 1, where each sample has white noise of this
  /// variance.
  Eigen::ArrayXd signal(double variance) const;
  /// Mean square of a coefficient in each band; 0 where a band has none.
  const Eigen::ArrayXd& power() const { return power_; }

 private:
  Index longest_;  // samples
  Eigen::ArrayXd power_;
};

/// What is expected of a witness without white noise of its own of this variance per sample: what
/// is left tells an effect that follows the signal without bias (Fuller 1987, Measurement Error
/// Models, section 1.2), because noise that the filter leaves is uncorrelated with it.
Witness without_noise(const Witness& witness, double variance);

}  // namespace imunoise
