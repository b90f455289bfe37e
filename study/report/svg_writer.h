#pragma once

// The few SVG shapes that the figures are made of. Geometry is written here; colours, weights and
// dashes belong to the classes of assets/plot.css.

#include <string>
#include <string_view>
#include <vector>

namespace imunoise::report {

struct Point {
  double x = 0.0;  ///< px
  double y = 0.0;  ///< px
};

struct Box {
  double left = 0.0;
  double top = 0.0;
  double right = 0.0;
  double bottom = 0.0;
  bool overlaps(const Box& other) const;
  bool contains(const Box& other) const;
};

enum class Anchor { kStart, kMiddle, kEnd };

/// Width of a text in px, on the safe side: fonts differ, and the reader's is not known here.
double text_width(std::string_view text, double size);

/// The box of a text whose baseline begins, is centred or ends at `at`.
Box text_box(Point at, std::string_view text, double size, Anchor anchor);

/// Lines of at most `width` px, broken at spaces.
std::vector<std::string> wrap_px(std::string_view text, double size, double width);

class SvgWriter {
 public:
  void open(std::string_view tag_and_attributes);  ///< "g class=\"x\""
  void close(std::string_view tag);
  void raw(std::string_view markup) { out_ += markup; }
  void line(std::string_view css_class, Point from, Point to);
  void rect(std::string_view css_class, const Box& box, std::string_view attributes = {});
  void circle(std::string_view css_class, Point centre, double radius);
  void path(std::string_view css_class, const std::vector<Point>& points, bool closed = false);
  /// `text` is escaped here.
  void text(std::string_view css_class, Point at, std::string_view text, double size,
            Anchor anchor);
  /// 10 to the power of an exponent, as a raised number.
  void power_of_ten(std::string_view css_class, Point at, int exponent, double size, Anchor anchor);
  const std::string& str() const { return out_; }

 private:
  void begin_text(std::string_view css_class, Point at, double size, Anchor anchor);
  std::string out_;
};

}  // namespace imunoise::report
