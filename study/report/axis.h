#pragma once

// From data to position: the axes that the drawings and the terminal share.

#include <vector>

namespace imunoise::report {

/// A range of positive values that grows with what it is shown; zeros, negatives and non-finite
/// values have no place on a logarithmic axis and are passed over.
class LogRange {
 public:
  void include(double value);
  bool empty() const { return low_ > high_; }
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  double low_ = 1e300;
  double high_ = -1.0;
};

struct Tick {
  double value = 0.0;
  bool major = false;  ///< Has a label.
};

/// True when a logarithmic axis has a place for the value.
bool drawable(double value);

/// A logarithmic axis: low ↦ begin, high ↦ end (positions may fall, as y does in SVG).
class LogAxis {
 public:
  /// Needs 0 < low < high.
  LogAxis(double low, double high, double begin, double end);

  /// Position of a positive value; values outside [low, high] lie outside [begin, end].
  double operator()(double value) const;
  bool holds(double value) const { return value >= low_ && value <= high_; }
  double low() const { return low_; }
  double high() const { return high_; }
  double begin() const { return begin_; }
  double end() const { return end_; }

  /// Decades, and 2..9 times them while there is room; major where labels of `label` width fit.
  std::vector<Tick> decade_ticks(double label) const;

  /// Where an axis spans few decades: 1, 2 and 5 times each decade are major if they fit, else
  /// decades.
  std::vector<Tick> fine_ticks(double label) const;

 private:
  double low_;
  double high_;
  double begin_;
  double end_;
};

/// A linear axis: low ↦ begin, high ↦ end (positions may fall).
class LinearAxis {
 public:
  /// Needs low < high.
  LinearAxis(double low, double high, double begin, double end);

  /// Position of a value; values outside [low, high] lie outside [begin, end].
  double operator()(double value) const;
  double low() const { return low_; }
  double high() const { return high_; }
  double begin() const { return begin_; }
  double end() const { return end_; }

  /// Multiples of 1, 2 or 5 times a power of ten, as many as leave `label` px for each.
  std::vector<double> ticks(double label) const;

 private:
  double low_;
  double high_;
  double begin_;
  double end_;
};

/// The axis of residuals, in standard deviations: asinh(r/2), nearly linear within ±2 and
/// logarithmic beyond, so that 1σ and 50σ are both legible.
class SigmaAxis {
 public:
  /// ±reach maps to centre ∓ half.
  SigmaAxis(double reach, double centre, double half);

  double operator()(double sigma) const;
  double reach() const { return reach_; }

  /// 0, ±2 and those of ±5, ±10, ±20, ±50, .. within reach.
  std::vector<double> ticks() const;

 private:
  double reach_;
  double centre_;
  double half_;
};

}  // namespace imunoise::report
