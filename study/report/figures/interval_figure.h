#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/figure/figure.h"

namespace imunoise::report {

/// One row: a name, a value and its interval.
struct IntervalRow {
  std::string name;
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  bool marked = false;  ///< drawn in the colour of trouble
};

/// Rows of values with their intervals on a logarithmic axis, with a line at `reference` where
/// there is one; ends that are zero or negative run to the axis's edge. A value that has no place
/// on such an axis has no row; nothing when no row is left.
std::optional<figure::Figure> interval_figure(const std::string& title,
                                              const std::string& axis_title,
                                              const std::string& caption,
                                              const std::vector<IntervalRow>& rows,
                                              std::optional<double> reference);

}  // namespace imunoise::report
