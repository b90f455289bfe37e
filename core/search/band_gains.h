#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "core/regression/current.h"
#include "core/search/evidence.h"

namespace imunoise {

/// Products of a whitened regressor with what a model leaves, and its squares, a band each, of all
/// replicates.
struct BandSums {
  Eigen::ArrayXd product;
  Eigen::ArrayXd square;
};

/// `regressor`: one cosine_transform() a replicate. `edges`: of a replicate of so many samples, the
/// place of the first coefficient of each band, and the end; as many for each.
BandSums band_sums(const Current& current, const std::vector<SharedVector>& regressor,
                   const std::function<std::vector<Eigen::Index>(Eigen::Index samples)>& edges);

/// What a regressor explains of what a model leaves, of all replicates, by octaves of frequency:
/// octave i begins at 2^i/2T, where T is the longest replicate.
class BandGains {
 public:
  using Index = Eigen::Index;

  /// Parts of the frequencies are tried from here on; below there is too little to tell.
  static constexpr Index kFirst = 4;

  /// `regressor`: one cosine_transform() a replicate.
  BandGains(const Current& current, const std::vector<SharedVector>& regressor);

  /// The octave that begins above all frequencies.
  Index end() const { return product_.size() - 1; }
  /// Where an octave begins, Hz.
  double hertz(Index octave) const;
  /// Nats that the frequencies from the beginning of one octave to that of another explain, with
  /// one coefficient.
  double gain(Index from, Index to) const;
  /// 1/variance of that coefficient.
  double information(Index from, Index to) const { return square_(to) - square_(from); }

  /// One coefficient per octave; the first one also covers everything slower.
  struct Octaves {
    Index to = 0;     ///< where the last ends
    Index count = 0;  ///< 0: none
    double gain = 0.0;
    Search search{};  ///< of all ends and numbers, beside one coefficient for all
    /// Logarithm of the p-value.
    double log_p = 0.0;
  };
  /// Of all ends and numbers of octaves, those of the best evidence. What another sensor says of a
  /// motion counts the less the more of its own noise it has at a frequency (Wiener 1949).
  Octaves best_octaves() const;

 private:
  double first_hertz_;  // where octave 0 begins
  // Sums below the beginning of each octave: products of the whitened regressor with what is left,
  // and its squares.
  Eigen::ArrayXd product_;
  Eigen::ArrayXd square_;
};

}  // namespace imunoise
