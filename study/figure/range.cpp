#include "study/figure/range.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace imunoise::figure {
namespace {

constexpr double kMargin = 0.05;        // of the axis, beyond the outermost value
constexpr double kSideMargin = 0.035;   // the same of an x-axis
constexpr double kRoomForNames = 0.06;  // on the right, where lines have names
constexpr double kRoomToLeave = 0.12;   // below, where lines leave the panel
constexpr double kMostStretch = 5.0;    // an interval's end over its value, on a logarithmic axis
constexpr double kMostRoom = 1.0;       // for intervals on either side, over the values' range,
constexpr double kMostMedian = 1.5;     // or over half an interval, the median
constexpr double kLeastRange = 0.02;    // of the largest value
constexpr double kLeastReach = 4.0;     // of an axis of standard deviations

class Reach {
 public:
  explicit Reach(AxisKind kind) : kind_(kind) {}

  void add(double value) {
    if (!has_place(kind_, value)) return;
    low_ = std::min(low_, value);
    high_ = std::max(high_, value);
  }
  // The end of an interval about a value. On a linear axis it waits for the range of all values.
  void add_end(double end, double value) {
    if (!has_place(kind_, end)) return;
    if (kind_ != AxisKind::kLogarithmic || !has_place(kind_, value)) {
      ends_low_ = std::min(ends_low_, end);
      ends_high_ = std::max(ends_high_, end);
      if (has_place(kind_, value)) halves_.push_back(std::abs(end - value));
    } else {
      add(std::clamp(end, value / kMostStretch, value * kMostStretch));
    }
  }
  // What has no value beside it counts in full; an end at zero has its room on a logarithmic axis.
  void add_interval(const Datum& from, double value) {
    const bool to_zero = kind_ == AxisKind::kLogarithmic && from.lower <= 0.0;
    if (to_zero && has(value)) add(value / kMostStretch);
    const bool known = has_place(kind_, value);
    for (const double end : {from.lower, from.upper}) {
      if (known) {
        add_end(end, value);
      } else {
        add(end);
      }
    }
  }
  bool has(double value) const { return has_place(kind_, value); }
  bool empty() const { return low_ > high_ && ends_low_ > ends_high_; }

  // Both ends, with intervals in the room that they may have.
  std::array<double, 2> ends() const {
    if (low_ > high_) return {ends_low_, ends_high_};
    const double size = std::max(std::abs(low_), std::abs(high_));
    const double room = std::max(kMostRoom * std::max(high_ - low_, kLeastRange * size),
                                 kMostMedian * median_half());
    return {std::min(low_, std::max(ends_low_, low_ - room)),
            std::max(high_, std::min(ends_high_, high_ + room))};
  }

 private:
  double median_half() const {
    if (halves_.empty()) return 0.0;
    std::vector<double> sorted = halves_;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return *middle;
  }

  AxisKind kind_;
  std::vector<double> halves_;  // of intervals about values
  double low_ = INFINITY;
  double high_ = -INFINITY;
  double ends_low_ = INFINITY;
  double ends_high_ = -INFINITY;
};

void add_across(Reach& reach, const Layer& layer) {
  if (!layer.widens || layer.shape == Shape::kMarks || layer.shape == Shape::kColumns) return;
  for (const Datum& one : layer.data) {
    switch (layer.shape) {
      case Shape::kCells:
        reach.add(one.lower);
        reach.add(one.upper);
        break;
      case Shape::kIntervals:
        reach.add(one.x);
        reach.add_interval(one, one.x);
        break;
      default:
        reach.add(one.x);
    }
  }
}

void add_up(Reach& reach, const Layer& layer) {
  if (!layer.widens) return;
  for (const Datum& one : layer.data) {
    switch (layer.shape) {
      case Shape::kLine:
      case Shape::kBars:
        reach.add(one.y);
        break;
      case Shape::kPoints:
        if (reach.has(one.y)) reach.add_interval(one, one.y);
        reach.add(one.y);
        break;
      case Shape::kBand:
        reach.add(one.y);
        reach.add_interval(one, one.y);
        break;
      case Shape::kRows:
        reach.add_end(one.lower, kUnknown);
        reach.add_end(one.upper, kUnknown);
        break;
      default:
        break;
    }
  }
}

// Ends that differ, however little the values do.
Scale between(AxisKind kind, double low, double high, double below, double above) {
  if (kind == AxisKind::kLogarithmic) {
    const double span = low < high ? std::log(high / low) : std::log(4.0);
    const double centre = low < high ? 0.0 : 0.5 * span;
    return {kind, low * std::exp(-below * span - centre), high * std::exp(above * span + centre)};
  }
  double span = high - low;
  const double size = std::max(std::abs(low), std::abs(high));
  if (!(span > 1e-12 * size)) {
    const double half = size > 0.0 ? 0.05 * size : 1.0;
    low -= half;
    high += half;
    span = 2.0 * half;
  }
  // An axis of what cannot be negative has no part below zero.
  const double floor = low >= 0.0 ? 0.0 : -INFINITY;
  return {kind, std::max(floor, low - below * span), high + above * span};
}

Scale scale_of(const Axis& axis, Reach reach, double below, double above) {
  if (axis.kind == AxisKind::kCategories && !axis.categories.empty()) {
    return Scale(axis.categories);
  }
  if (axis.low) reach.add(*axis.low);
  if (axis.high) reach.add(*axis.high);
  if (reach.empty()) return {axis.kind, 1.0, 10.0};
  const auto [low, high] = reach.ends();
  const Scale free = between(axis.kind, low, high, below, above);
  const double from = axis.low.value_or(free.low());
  const double to = axis.high.value_or(free.high());
  return from < to ? Scale(axis.kind, from, to) : free;
}

Scale sigma_scale(const Panel& panel) {
  double reach = kLeastReach;
  for (const Layer& layer : panel.layers) {
    for (const Datum& one : layer.data) {
      if (std::isfinite(one.y)) reach = std::max(reach, 1.15 * std::abs(one.y));
    }
  }
  return {AxisKind::kSigma, -reach, reach};
}

}  // namespace

std::vector<Stack> stacks(const std::vector<Panel>& panels) {
  std::vector<Stack> out;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    if (!panels[i].shares_x || out.empty()) out.push_back({i, i});
    out.back().end = i + 1;
  }
  return out;
}

Scale x_scale(const std::vector<Panel>& panels, const Stack& stack) {
  const Panel& leader = panels[stack.first];
  Reach reach(leader.x.kind);
  bool names = false;
  bool cells = false;
  if (leader.x_reference) reach.add(*leader.x_reference);
  for (std::size_t i = stack.first; i < stack.end; ++i) {
    for (const Layer& layer : panels[i].layers) {
      add_across(reach, layer);
      names = names || layer.labelled;
      cells = cells || layer.shape == Shape::kCells;
      const bool lying = layer.shape == Shape::kBars && panels[i].y.kind == AxisKind::kCategories;
      if (lying) reach.add(0.0);
    }
  }
  const double side = cells ? 0.0 : kSideMargin;
  return scale_of(leader.x, reach, side, names ? side + kRoomForNames : side);
}

Scale y_scale(const Panel& panel) {
  if (panel.y.kind == AxisKind::kSigma) return sigma_scale(panel);
  Reach reach(panel.y.kind);
  bool leaves = false;
  for (const Layer& layer : panel.layers) {
    add_up(reach, layer);
    leaves = leaves || !layer.widens;
    if (layer.shape == Shape::kBars) reach.add(0.0);
  }
  if (panel.y_reference) reach.add(*panel.y_reference);
  return scale_of(panel.y, reach, leaves ? kRoomToLeave : kMargin, kMargin);
}

bool has_numbers(const Panel& panel) {
  return std::any_of(panel.layers.begin(), panel.layers.end(), [&](const Layer& layer) {
    Reach across(panel.x.kind);
    Reach up(panel.y.kind);
    add_across(across, layer);
    add_up(up, layer);
    const bool rows = layer.shape == Shape::kIntervals || layer.shape == Shape::kCells;
    return layer.widens && layer.shape != Shape::kRows && !across.empty() && (rows || !up.empty());
  });
}

std::optional<Figure> unless_empty(Figure figure) {
  if (std::none_of(figure.panels.begin(), figure.panels.end(), has_numbers)) return std::nullopt;
  return figure;
}

}  // namespace imunoise::figure
