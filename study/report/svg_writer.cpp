#include "study/report/svg_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "study/words/text.h"

namespace imunoise::report {
namespace {

// Of the font size. DejaVu Sans, the widest of the fonts that the figures ask for, averages 0.59.
constexpr double kCharacterWidth = 0.6;
constexpr double kCapitalExtra = 0.15;
constexpr double kAscent = 0.8;
constexpr double kDescent = 0.25;

std::string px(double value) {
  assert(std::isfinite(value));
  std::string out = fmt::format("{:.2f}", value);
  out.erase(out.find_last_not_of('0') + 1);
  if (out.back() == '.') out.pop_back();
  return out == "-0" ? "0" : out;
}

}  // namespace

bool Box::overlaps(const Box& other) const {
  return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
}

bool Box::contains(const Box& other) const {
  return left <= other.left && other.right <= right && top <= other.top && other.bottom <= bottom;
}

double text_width(std::string_view text, double size) {
  const auto capitals =
      std::count_if(text.begin(), text.end(), [](char c) { return c >= 'A' && c <= 'Z'; });
  return (static_cast<double>(display_width(text)) * kCharacterWidth +
          static_cast<double>(capitals) * kCapitalExtra) *
         size;
}

Box text_box(Point at, std::string_view text, double size, Anchor anchor) {
  const double width = text_width(text, size);
  const double left = anchor == Anchor::kStart    ? at.x
                      : anchor == Anchor::kMiddle ? at.x - width / 2.0
                                                  : at.x - width;
  return {left, at.y - kAscent * size, left + width, at.y + kDescent * size};
}

std::vector<std::string> wrap_px(std::string_view text, double size, double width) {
  std::vector<std::string> lines;
  std::string line;
  while (!text.empty()) {
    const auto space = text.find(' ');
    const std::string word(text.substr(0, space));
    text.remove_prefix(space == std::string_view::npos ? text.size() : space + 1);
    if (!line.empty() && text_width(line + " " + word, size) > width) {
      lines.push_back(std::exchange(line, ""));
    }
    line += line.empty() ? word : " " + word;
  }
  if (!line.empty()) lines.push_back(line);
  return lines;
}

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

void SvgWriter::circle(std::string_view css_class, Point centre, double radius) {
  out_ += fmt::format("<circle class=\"{}\" cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n", css_class,
                      px(centre.x), px(centre.y), px(radius));
}

void SvgWriter::path(std::string_view css_class, const std::vector<Point>& points, bool closed) {
  if (points.empty()) return;
  out_ += fmt::format(R"(<path class="{}" d=")", css_class);
  char command = 'M';
  for (const Point& point : points) {
    out_ += fmt::format("{}{},{}", command, px(point.x), px(point.y));
    command = 'L';
  }
  out_ += closed ? "Z\"/>\n" : "\"/>\n";
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
  out_ += escape_markup(text) + "</text>\n";
}

void SvgWriter::power_of_ten(std::string_view css_class, Point at, int exponent, double size,
                             Anchor anchor) {
  begin_text(css_class, at, size, anchor);
  out_ += fmt::format("10<tspan dy=\"{}\" font-size=\"{}\">{}{}</tspan></text>\n", px(-0.4 * size),
                      px(0.75 * size), exponent < 0 ? "−" : "", std::abs(exponent));
}

}  // namespace imunoise::report
