#pragma once

// Cells in rows and columns whose colour says by how many standard deviations they deviate.

#include <optional>
#include <string>
#include <vector>

#include "study/report/documents/document.h"

namespace imunoise::report {

struct HeatCell {
  double sigma = 0.0;  ///< sign and strength of the colour
  std::string mark;    ///< written into it, where it has room
};

struct HeatMap {
  std::string title;
  std::string caption;
  std::string axis_title;            ///< under the columns
  std::vector<std::string> rows;     ///< names
  std::vector<std::string> columns;  ///< labels; an empty one is not written
  /// A row each of as many cells as there are columns; nothing where a cell has no meaning.
  std::vector<std::vector<std::optional<HeatCell>>> cells;
};

/// Nothing without cells.
std::optional<Figure> heat_map(const HeatMap& map);

/// Style class of a cell: sign and strength.
std::string cell_class(double sigma);

}  // namespace imunoise::report
