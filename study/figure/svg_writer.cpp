#include "study/figure/svg_writer.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>

#include "study/words/text.h"

namespace imunoise::figure {
namespace {

std::string px(double value) {
  assert(std::isfinite(value));
  std::string out = fmt::format("{:.2f}", value);
  out.erase(out.find_last_not_of('0') + 1);
  if (out.back() == '.') out.pop_back();
  return out == "-0" ? "0" : out;
}

}  // namespace

void SvgWriter::open(std::string_view tag_and_attributes) {
  out_ += fmt::format("<{}>\n", tag_and_attributes);
}

void SvgWriter::close(std::string_view tag) { out_ += fmt::format("</{}>\n", tag); }

void SvgWriter::line(std::string_view css_class, Point from, Point to) {
  out_ += fmt::format("<line class=\"{}\" x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"/>\n", css_class,
                      px(from.x), px(from.y), px(to.x), px(to.y));
}

void SvgWriter::rect(std::string_view css_class, const Box& box, std::string_view attributes) {
  out_ += fmt::format("<rect class=\"{}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"{}{}/>\n",
                      css_class, px(box.left), px(box.top), px(box.right - box.left),
                      px(box.bottom - box.top), attributes.empty() ? "" : " ", attributes);
}

void SvgWriter::circle(std::string_view css_class, Point centre, double radius,
                       std::string_view attributes) {
  out_ += fmt::format("<circle class=\"{}\" cx=\"{}\" cy=\"{}\" r=\"{}\"{}{}/>\n", css_class,
                      px(centre.x), px(centre.y), px(radius), attributes.empty() ? "" : " ",
                      attributes);
}

void SvgWriter::begin_path(std::string_view css_class) {
  out_ += fmt::format(R"(<path class="{}" d=")", css_class);
}

void SvgWriter::add_line(const std::vector<Point>& line) {
  char command = 'M';
  for (const Point& point : line) {
    out_ += fmt::format("{}{},{}", command, px(point.x), px(point.y));
    command = 'L';
  }
}

void SvgWriter::path(std::string_view css_class, const std::vector<std::vector<Point>>& lines) {
  if (lines.empty()) return;
  begin_path(css_class);
  for (const std::vector<Point>& line : lines) add_line(line);
  out_ += "\"/>\n";
}

void SvgWriter::area(std::string_view css_class, const std::vector<Point>& outline) {
  if (outline.empty()) return;
  begin_path(css_class);
  add_line(outline);
  out_ += "Z\"/>\n";
}

void SvgWriter::begin_text(std::string_view css_class, Point at, double size, Anchor anchor) {
  const char* const name = anchor == Anchor::kStart    ? "start"
                           : anchor == Anchor::kMiddle ? "middle"
                                                       : "end";
  out_ += fmt::format(R"(<text class="{}" x="{}" y="{}" font-size="{}" text-anchor="{}">)",
                      css_class, px(at.x), px(at.y), px(size), name);
}

void SvgWriter::text(std::string_view css_class, Point at, std::string_view text, double size,
                     Anchor anchor) {
  begin_text(css_class, at, size, anchor);
  out_ += report::escape_markup(text) + "</text>\n";
}

void SvgWriter::power_of_ten(std::string_view css_class, Point at, int exponent, double size,
                             Anchor anchor) {
  begin_text(css_class, at, size, anchor);
  out_ += fmt::format("10<tspan dy=\"{}\" font-size=\"{}\">{}{}</tspan></text>\n", px(-0.4 * size),
                      px(0.75 * size), exponent < 0 ? "−" : "", std::abs(exponent));
}

}  // namespace imunoise::figure
