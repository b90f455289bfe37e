#include "study/report/figures/error_panel.h"

#include <algorithm>
#include <cmath>

namespace imunoise::report {
namespace {

constexpr double kBeyond = 0.05 / 7.0;  // of any of seven views once in twenty

double over_floor(const v1::ErrorView& view) {
  if (view.unit() == "dB") return std::pow(10.0, (view.value() - view.floor()) / 20.0);
  return view.value() / view.floor();
}

// Bars of the views that `now` has, in its order.
figure::Layer bars(const v1::Rung& of, const v1::Rung& now, figure::Role role) {
  figure::Layer out{.shape = figure::Shape::kBars, .role = role};
  for (int row = 0; row < now.views_size(); ++row) {
    for (const v1::ErrorView& one : of.views()) {
      if (one.view() != now.views(row).view() || !(over_floor(one) > 0.0)) continue;
      const bool beyond = one.p() < kBeyond;
      out.data.push_back({.x = over_floor(one),
                          .y = static_cast<double>(row),
                          .state = beyond ? figure::State::kOutside : figure::State::kPlain});
    }
  }
  return out;
}

}  // namespace

std::string view_title(const v1::ErrorView& view) {
  std::string out = view.view();
  std::replace(out.begin(), out.end(), '_', ' ');
  return out;
}

std::optional<figure::Figure> error_panel(const v1::DiagnosisReport& report) {
  if (report.ladder_size() == 0) return std::nullopt;
  const v1::Rung& now = report.ladder(report.ladder_size() - 1);
  const bool grown = report.ladder_size() > 1;
  // A bar begins at the axis's edge: below the floor it is short, not absent.
  constexpr double kEdge = 0.2;
  figure::Panel panel{.x = {.kind = figure::AxisKind::kLogarithmic,
                            .title = "error over its floor, 1 = what chance leaves",
                            .short_title = "error / floor",
                            .low = kEdge},
                      .y = {.kind = figure::AxisKind::kCategories},
                      .x_reference = 1.0};
  for (const v1::ErrorView& one : now.views()) panel.y.categories.push_back(view_title(one));
  if (grown) panel.layers.push_back(bars(report.ladder(0), now, figure::Role::kGhost));
  panel.layers.push_back(bars(now, now, figure::Role::kMeasured));
  return figure::unless_empty(
      {.title = "How far the model is off",
       .caption = std::string(grown ? "Outlines: the first model. Bars: the last one. " : "") +
                  "The line is what chance alone leaves under a true model; orange bars are longer "
                  "than chance makes any of them once in twenty.",
       .panels = {std::move(panel)}});
}

}  // namespace imunoise::report
