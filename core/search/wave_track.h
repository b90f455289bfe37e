#pragma once

// Waves whose frequency moves slowly. A replicate is cut into pieces, in each of which the
// frequency hardly moves. Its track is the chain of frequencies, one a piece, that explains most
// where neighbours are close (Viterbi's algorithm: Streit & Barrett 1990, IEEE Trans. ASSP 38:586;
// Suvorova et al. 2016, Phys. Rev. D 93:123009).

#include <vector>

#include "core/search/wave_scores.h"

namespace imunoise {

/// Places of a transform between two frequencies.
struct Band {
  Eigen::Index first;
  Eigen::Index last;  ///< included
  Eigen::Index size() const { return last - first + 1; }
};

/// The gains of waves in the pieces of a replicate.
struct WavePieces {
  std::size_t replicate = 0;
  Eigen::Index length = 0;  ///< of a piece, samples
  Eigen::Index padded = 1;
  Eigen::ArrayXXd gain{};  ///< at frequencies i/padded (half bins) × pieces, nats

  Stretch piece(Eigen::Index p) const { return {replicate, p * length, length}; }
  /// Cycles per sample.
  double frequency(Eigen::Index place) const {
    return static_cast<double>(place) / static_cast<double>(padded);
  }
  /// Frequencies in cycles per sample; at least one place.
  Band band(double low, double high) const;
  /// Logarithm of how many tracks a band has.
  double log_tracks(const Band& in) const;
};

WavePieces wave_pieces(const Current& current, std::size_t replicate, Eigen::Index count);

/// The most that any track gains, nats, by its place in the middle piece.
Eigen::ArrayXd gained_through_middle(const WavePieces& pieces);

/// A place a piece.
using WaveTrack = std::vector<Eigen::Index>;
/// The track in a band that gains most.
WaveTrack best_track(const WavePieces& pieces, const Band& in);
double gain_of(const WavePieces& pieces, const WaveTrack& track);

/// Phase of a track at each sample of its replicate, rad. Between the middles of the pieces it is
/// the smoothest cubic that joins their phases and frequencies (McAulay & Quatieri 1986, IEEE
/// Trans. ASSP 34:744).
Eigen::ArrayXd phase_of(const Current& current, const WavePieces& pieces, const WaveTrack& track);

}  // namespace imunoise
