#pragma once

// Where a recording is cut, and which stretches remain.

#include <cstddef>
#include <vector>

#include "recording/import/preflight/preflight.h"

namespace imunoise::recording {

/// Rows [begin, end) are left out; where both are one, the recording is cut before it.
struct Cut {
  std::size_t begin = 0;
  std::size_t end = 0;
};

class Cuts {
 public:
  void add(std::size_t begin, std::size_t end) { all_.push_back({begin, end}); }
  /// Leaves out one row; rows that follow each other make one cut.
  void add_row(std::size_t row);

  /// All so far, by their begin, joined where they meet.
  std::vector<Cut> joined() const;

  /// What is left of so many rows.
  struct Left {
    std::vector<Stretch> stretches;  ///< not shorter than kMinimumSamples or a tenth of the longest
    std::size_t longest = 0;         ///< rows, of all
    std::size_t all = 0;             ///< stretches, the short ones included
  };
  Left of(std::size_t rows) const;

 private:
  std::vector<Cut> all_;
};

}  // namespace imunoise::recording
