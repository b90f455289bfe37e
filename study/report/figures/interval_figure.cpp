#include "study/report/figures/interval_figure.h"

#include <cmath>

namespace imunoise::report {

std::optional<figure::Figure> interval_figure(const std::string& title,
                                              const std::string& axis_title,
                                              const std::string& caption,
                                              const std::vector<IntervalRow>& rows,
                                              std::optional<double> reference) {
  figure::Panel panel{.x = {.kind = figure::AxisKind::kLogarithmic, .title = axis_title},
                      .y = {.kind = figure::AxisKind::kCategories},
                      .x_reference = reference};
  figure::Layer layer{.shape = figure::Shape::kIntervals, .role = figure::Role::kMeasured};
  for (const IntervalRow& row : rows) {
    if (!std::isfinite(row.value) || row.value <= 0.0) continue;
    panel.y.categories.push_back(row.name);
    layer.data.push_back({.x = row.value,
                          .y = static_cast<double>(panel.y.categories.size() - 1),
                          .lower = row.lower,
                          .upper = row.upper,
                          .state = row.marked ? figure::State::kOutside : figure::State::kPlain});
  }
  panel.layers = {std::move(layer)};
  return figure::unless_empty({.title = title, .caption = caption, .panels = {std::move(panel)}});
}

}  // namespace imunoise::report
