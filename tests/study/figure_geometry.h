#pragma once

// Where the elements of a figure stand, for tests.

#include <string>
#include <utility>
#include <vector>

#include "study/figure/geometry.h"
#include "tests/study/markup_check.h"

namespace imunoise::report {

using figure::Box;
using figure::Point;

double value(const Element& element, const std::string& name);

/// Corners and ends of a line, circle, rectangle or path; none of other elements and the paper.
std::vector<Point> points_of(const Element& element);

/// Boxes of all texts; the raised exponent of a power of ten counts at full size.
std::vector<std::pair<std::string, Box>> text_boxes(const Markup& markup);

/// That a figure is well-formed, free of "nan" and "inf", and drawn inside its canvas.
void expect_sound(const std::string& svg, const std::string& name);

/// That no text overlaps another or leaves the canvas.
void expect_texts_apart(const std::string& svg, const std::string& name);

}  // namespace imunoise::report
