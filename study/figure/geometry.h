#pragma once

// Points, boxes and texts on a picture, in px; y grows downwards.

#include <string>
#include <string_view>
#include <vector>

namespace imunoise::figure {

struct Point {
  double x = 0.0;
  double y = 0.0;
};

struct Box {
  double left = 0.0;
  double top = 0.0;
  double right = 0.0;
  double bottom = 0.0;
  double width() const { return right - left; }
  double height() const { return bottom - top; }
  bool overlaps(const Box& other) const;
  bool contains(const Box& other) const;
  bool contains(Point point) const { return contains({point.x, point.y, point.x, point.y}); }
  Point nearest(Point point) const;  ///< the point of the box that is closest
};

enum class Anchor { kStart, kMiddle, kEnd };

/// Width of a text in px, on the safe side: fonts differ, and the reader's is not known here.
double text_width(std::string_view text, double size);

/// The box of a text whose baseline begins, is centred or ends at `at`.
Box text_box(Point at, std::string_view text, double size, Anchor anchor);

/// Lines of at most `width` px, broken at spaces.
std::vector<std::string> wrap_px(std::string_view text, double size, double width);

/// One clean line of at most `width` px, cut with an ellipsis.
std::string fitted(std::string_view text, double size, double width);

/// The parts of a polyline inside a box, in order.
std::vector<std::vector<Point>> clipped(const std::vector<Point>& line, const Box& box);

}  // namespace imunoise::figure
