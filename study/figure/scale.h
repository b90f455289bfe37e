#pragma once

// From values to places on an axis, and the ticks that name them.

#include <optional>
#include <string>
#include <vector>

#include "study/figure/figure.h"

namespace imunoise::figure {

/// True where an axis of this kind has a place for the value.
bool has_place(AxisKind kind, double value);

struct Tick {
  double value = 0.0;
  bool major = false;             ///< has a label
  std::string label{};            ///< empty where the label is a power of ten
  std::optional<int> exponent{};  ///< of ten
};

/// The label as one text: superscripts in Unicode, "1e-7" in ASCII.
std::string label_text(const Tick& tick, bool unicode = true);

class Scale {
 public:
  /// Needs low < high, both with a place on an axis of this kind.
  Scale(AxisKind kind, double low, double high);
  /// Places 0 .. n - 1 of n ≥ 1 names.
  explicit Scale(std::vector<std::string> categories);

  /// low ↦ 0, high ↦ 1; values outside lie outside. Needs a value that has a place.
  double operator()(double value) const;
  bool holds(double value) const { return value >= low_ && value <= high_; }
  AxisKind kind() const { return kind_; }
  double low() const { return low_; }
  double high() const { return high_; }
  /// low() and high() at factor · valueᵉˣᵖᵒⁿᵉⁿᵗ; for logarithmic scales.
  Scale relabelled(double factor, double exponent) const;

  /// Ticks of an axis `length` long, on which a label needs `label`, in the same unit; minor ones
  /// keep `gap` apart.
  std::vector<Tick> ticks(double length, double label, double gap) const;

 private:
  std::vector<Tick> decades(double length, double label, double gap) const;
  std::vector<Tick> steps(double least) const;
  std::vector<Tick> sigmas(double length, double label) const;
  std::vector<Tick> names(double length, double label) const;

  AxisKind kind_;
  double low_;
  double high_;
  std::vector<std::string> categories_{};
};

}  // namespace imunoise::figure
