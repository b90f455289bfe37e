#pragma once

// Values that are missing, or are those of the row before.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "recording/import/table/table.h"

namespace imunoise::recording {

/// Whether a column has no value in a row.
bool missing(const Column& column, std::size_t row);

/// Whether a column has the value of the row before. Precondition: row > 0.
bool repeats(const Column& column, std::size_t row);

/// Values that columns miss; those that miss as many from the same row on are told together.
struct Hole {
  std::vector<std::string> names;
  std::size_t count = 0;  ///< of each column
  std::size_t first = 0;  ///< row

  /// "channels wx, wy miss 20 values each".
  std::string said() const;
};

std::vector<Hole> holes_in(std::span<const Column> columns);

}  // namespace imunoise::recording
