#pragma once

// The few SVG shapes that the figures are made of. Geometry is written here; colours, weights and
// dashes belong to the classes of assets/plot.css.

#include <string>
#include <string_view>
#include <vector>

#include "study/figure/geometry.h"

namespace imunoise::figure {

class SvgWriter {
 public:
  void open(std::string_view tag_and_attributes);  ///< "g class=\"x\""
  void close(std::string_view tag);
  void raw(std::string_view markup) { out_ += markup; }
  void line(std::string_view css_class, Point from, Point to);
  void rect(std::string_view css_class, const Box& box, std::string_view attributes = {});
  void circle(std::string_view css_class, Point centre, double radius,
              std::string_view attributes = {});
  /// Several lines, as one.
  void path(std::string_view css_class, const std::vector<std::vector<Point>>& lines);
  void area(std::string_view css_class, const std::vector<Point>& outline);
  /// `text` is escaped here.
  void text(std::string_view css_class, Point at, std::string_view text, double size,
            Anchor anchor);
  /// 10 to the power of an exponent, as a raised number.
  void power_of_ten(std::string_view css_class, Point at, int exponent, double size, Anchor anchor);
  const std::string& str() const { return out_; }

 private:
  void begin_text(std::string_view css_class, Point at, double size, Anchor anchor);
  void begin_path(std::string_view css_class);
  void add_line(const std::vector<Point>& line);
  std::string out_;
};

}  // namespace imunoise::figure
