#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/report/documents/document.h"

namespace imunoise::report {

/// One row: a name, a value and its interval.
struct IntervalRow {
  std::string name;
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  bool marked = false;  ///< drawn in the colour of trouble
};

/// Rows of values with whiskers on a logarithmic axis, with a line at `reference` where there is
/// one; ends that are zero or negative run to the axis's edge. A value that has no place on such an
/// axis has no row; nothing when no row is left. For page figures: both widths.
std::optional<Figure> interval_chart(const std::string& title, const std::string& axis_title,
                                     const std::string& caption, std::vector<IntervalRow> rows,
                                     std::optional<double> reference);

/// The same as a picture for papers, 900 px wide, with title and subtitle; "" when no row is left.
std::string interval_svg(const std::string& title, const std::string& subtitle,
                         const std::string& axis_title, std::vector<IntervalRow> rows,
                         std::optional<double> reference);

}  // namespace imunoise::report
