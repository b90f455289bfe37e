#pragma once

#include <cstddef>

namespace imunoise::recording {

/// A straight line by least squares, of points that are given once.
class StraightLine {
 public:
  void add(double x, double y);
  std::size_t points() const { return points_; }
  double slope() const { return points_ > 1 ? xy_ / xx_ : 0.0; }
  double at(double x) const { return mean_y_ + slope() * (x - mean_x_); }
  /// Of the points about the line, with two degrees of freedom less; 0 for fewer than three.
  double standard_deviation() const;
  /// Of the slope, for independent deviations; 0 for fewer than three points.
  double slope_error() const;

 private:
  std::size_t points_ = 0;
  double mean_x_ = 0.0;
  double mean_y_ = 0.0;
  double xx_ = 0.0;  // sums of squares and products about the means
  double xy_ = 0.0;
  double yy_ = 0.0;
};

}  // namespace imunoise::recording
