#include "recording/store/timeline/straight_line.h"

#include <algorithm>
#include <cmath>

namespace imunoise::recording {

void StraightLine::add(double x, double y) {
  ++points_;
  const double n = static_cast<double>(points_);
  const double dx = x - mean_x_;
  const double dy = y - mean_y_;
  mean_x_ += dx / n;
  mean_y_ += dy / n;
  xx_ += dx * (x - mean_x_);
  xy_ += dx * (y - mean_y_);
  yy_ += dy * (y - mean_y_);
}

double StraightLine::standard_deviation() const {
  if (points_ < 3) return 0.0;
  return std::sqrt(std::max(0.0, yy_ - slope() * xy_) / static_cast<double>(points_ - 2));
}

double StraightLine::slope_error() const {
  return points_ < 3 ? 0.0 : standard_deviation() / std::sqrt(xx_);
}

}  // namespace imunoise::recording
