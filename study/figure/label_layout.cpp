#include "study/figure/label_layout.h"

#include <algorithm>
#include <cmath>

namespace imunoise::figure {
namespace {

constexpr double kStep = 4.0;          // px between points of a resampled curve
constexpr double kClearance = 5.0;     // px between a curve and its name
constexpr double kCrossed = 60.0;      // cost of a point of another curve under the name
constexpr double kFromRightEnd = 0.1;  // cost a px away from the right end

// Points at most kStep apart along a polyline, those inside the frame only.
std::vector<Point> resample(const std::vector<Point>& curve, const Box& frame) {
  std::vector<Point> out;
  for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
    const double length = std::hypot(curve[i + 1].x - curve[i].x, curve[i + 1].y - curve[i].y);
    const int steps = std::max(1, static_cast<int>(std::ceil(length / kStep)));
    for (int s = 0; s < steps; ++s) {
      const double t = static_cast<double>(s) / steps;
      const Point p{curve[i].x + t * (curve[i + 1].x - curve[i].x),
                    curve[i].y + t * (curve[i + 1].y - curve[i].y)};
      if (frame.contains({p.x, p.y, p.x, p.y})) out.push_back(p);
    }
  }
  if (curve.size() > 1 &&
      frame.contains({curve.back().x, curve.back().y, curve.back().x, curve.back().y})) {
    out.push_back(curve.back());
  }
  return out;
}

double covered(const Box& box, const std::vector<Point>& points) {
  const auto inside = [&](const Point& p) { return box.contains({p.x, p.y, p.x, p.y}); };
  return static_cast<double>(std::count_if(points.begin(), points.end(), inside));
}

}  // namespace

std::vector<CurveLabel> place_labels(const std::vector<std::vector<Point>>& curves,
                                     const std::vector<std::string>& names,
                                     const std::vector<Point>& obstacles, const Box& frame,
                                     double size) {
  std::vector<std::vector<Point>> lines;
  lines.reserve(curves.size());
  for (const auto& curve : curves) lines.push_back(resample(curve, frame));

  std::vector<CurveLabel> placed;
  for (std::size_t c = 0; c < names.size(); ++c) {
    double best_cost = INFINITY;
    CurveLabel best;
    for (const Point& on_curve : lines[c]) {
      for (const double baseline : {on_curve.y + 0.35 * size, on_curve.y - kClearance,
                                    on_curve.y + kClearance + 0.8 * size}) {
        for (const Anchor anchor : {Anchor::kStart, Anchor::kEnd}) {
          const double gap = anchor == Anchor::kStart ? kClearance : -kClearance;
          const Box box = text_box({on_curve.x + gap, baseline}, names[c], size, anchor);
          const auto collides = [&](const CurveLabel& other) { return box.overlaps(other.box); };
          if (!frame.contains(box) || std::any_of(placed.begin(), placed.end(), collides)) continue;
          double cost =
              kFromRightEnd * (frame.right - on_curve.x) + kCrossed * covered(box, obstacles);
          for (const auto& line : lines) cost += kCrossed * covered(box, line);
          if (cost < best_cost) {
            best_cost = cost;
            best = {c, {box.left, baseline}, box};
          }
        }
      }
    }
    if (std::isfinite(best_cost)) placed.push_back(best);
  }
  return placed;
}

}  // namespace imunoise::figure
