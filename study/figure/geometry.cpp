#include "study/figure/geometry.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "study/words/text.h"

namespace imunoise::figure {
namespace {

// Of the font size. DejaVu Sans, the widest of the fonts that the figures ask for, averages 0.59.
constexpr double kCharacterWidth = 0.6;
constexpr double kCapitalExtra = 0.15;
constexpr double kAscent = 0.8;
constexpr double kDescent = 0.25;

// The part of a segment inside a box, as fractions of it (Liang and Barsky, ACM Trans. Graphics 3,
// 1984).
std::optional<std::pair<double, double>> inside(Point from, Point to, const Box& box) {
  const double dx = to.x - from.x;
  const double dy = to.y - from.y;
  const std::array<std::pair<double, double>, 4> edges = {{{-dx, from.x - box.left},
                                                           {dx, box.right - from.x},
                                                           {-dy, from.y - box.top},
                                                           {dy, box.bottom - from.y}}};
  double begin = 0.0;
  double end = 1.0;
  for (const auto& [speed, distance] : edges) {
    if (speed == 0.0) {
      if (distance < 0.0) return std::nullopt;
      continue;
    }
    const double at = distance / speed;
    if (speed < 0.0) begin = std::max(begin, at);
    if (speed > 0.0) end = std::min(end, at);
  }
  if (begin > end) return std::nullopt;
  return std::pair(begin, end);
}

}  // namespace

bool Box::overlaps(const Box& other) const {
  return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
}

bool Box::contains(const Box& other) const {
  return left <= other.left && other.right <= right && top <= other.top && other.bottom <= bottom;
}

Point Box::nearest(Point point) const {
  return {std::clamp(point.x, left, right), std::clamp(point.y, top, bottom)};
}

double text_width(std::string_view text, double size) {
  const auto capitals =
      std::count_if(text.begin(), text.end(), [](char c) { return c >= 'A' && c <= 'Z'; });
  return (static_cast<double>(report::display_width(text)) * kCharacterWidth +
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

std::string fitted(std::string_view text, double size, double width) {
  std::string out = report::clean_text(text);
  std::size_t columns = report::display_width(out);
  while (columns > 1 && text_width(out, size) > width) {
    const double share = std::max(0.0, width) / text_width(out, size);
    columns = std::min(
        columns - 1,
        std::max<std::size_t>(1, static_cast<std::size_t>(share * static_cast<double>(columns))));
    out = report::shorten(out, columns);
  }
  return out;
}

std::vector<std::vector<Point>> clipped(const std::vector<Point>& line, const Box& box) {
  std::vector<std::vector<Point>> out;
  bool open = false;  // the last part goes on at the next segment
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Point from = line[i];
    const Point to = line[i + 1];
    const auto part = inside(from, to, box);
    if (!part) {
      open = false;
      continue;
    }
    const auto at = [&](double t) {
      return box.nearest({from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)});
    };
    if (!open) out.push_back({at(part->first)});
    out.back().push_back(at(part->second));
    open = part->second == 1.0;
  }
  return out;
}

}  // namespace imunoise::figure
