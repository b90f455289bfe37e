#pragma once

#include <string>
#include <vector>

#include "study/figure/geometry.h"

namespace imunoise::figure {

/// A name to be written beside its curve.
struct CurveLabel {
  std::size_t curve = 0;
  Point at;  ///< Baseline start, px.
  Box box;
};

/// Writes each curve's name along it, inside `frame`: where it covers least of the other curves,
/// the `obstacles` (measured points) and never another name; the right end is preferred. Curves (in
/// px; parts outside the frame do not count) that offer no free place get no label.
std::vector<CurveLabel> place_labels(const std::vector<std::vector<Point>>& curves,
                                     const std::vector<std::string>& names,
                                     const std::vector<Point>& obstacles, const Box& frame,
                                     double size);

}  // namespace imunoise::figure
