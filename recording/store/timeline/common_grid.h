#pragma once

// Samples of several streams, each with a clock of its own, that were taken together.

#include <cstddef>
#include <span>
#include <vector>

#include "recording/store/timeline/timeline.h"

namespace imunoise::recording {

/// A stream that is to stand beside others.
struct GridStream {
  std::vector<Timeline> timelines;
  /// Consecutive samples that are averaged into one: the ratio of its rate to the common one.
  std::size_t averaged = 1;
};

/// The samples of one stream on the grid: all of these rows, in order and each once; every
/// `averaged` of them make one. Between two parts rows are left out.
struct Picked {
  std::vector<Part> parts;
  std::size_t dropped = 0;  ///< Rows between the parts.
};

/// A stretch of time that all streams share.
struct GridPiece {
  std::size_t count = 0;       ///< Samples after averaging, the same of each stream.
  double period_ns = 0.0;      ///< From one to the next, by the host's clock.
  std::vector<Picked> picked;  ///< One a stream.
};

/// The times that all streams share, in order, without those of fewer than `fewest` samples. The
/// grid of each is that of the stream that is slowest after averaging: its samples are all taken,
/// and of any other the nearest in time, at most half a sample away. As the others are faster, none
/// comes twice, and every so often one is left out. Nothing is interpolated.
std::vector<GridPiece> common_grid(std::span<const GridStream> streams, std::size_t fewest);

/// Leaves the end of a piece out. Precondition: count ≤ piece.count.
void shorten(GridPiece& piece, std::size_t count);

/// How long the streams run together, s.
double seconds_together(std::span<const GridStream> streams);

}  // namespace imunoise::recording
