#include "study/report/figures/covariate_figure.h"

#include <cmath>

namespace imunoise::report {
namespace {

// Values that are not finite or below zero have no place.
std::vector<figure::Datum> places(const std::vector<CovariateValue>& from) {
  std::vector<figure::Datum> out;
  for (const CovariateValue& one : from) {
    if (!std::isfinite(one.covariate) || !std::isfinite(one.value) || one.value < 0.0) continue;
    out.push_back({.x = one.covariate, .y = one.value, .lower = one.lower, .upper = one.upper});
  }
  return out;
}

}  // namespace

std::optional<figure::Figure> covariate_figure(const CovariateValues& values) {
  using figure::Role;
  using figure::Shape;
  std::vector<figure::Datum> curve = places(values.curve);
  if (curve.size() < 2 || !(curve.front().x < curve.back().x)) return std::nullopt;
  std::vector<figure::Datum> points = places(values.points);
  for (figure::Datum& one : points) {
    if (one.lower > 0.0) continue;  // only its upper end means something
    one.lower = 0.0;
    one.state = figure::State::kUntested;
  }
  return figure::Figure{
      .title = values.title,
      .caption = values.caption,
      .panels = {{.x = {.title = values.covariate_title},
                  .y = {.title = values.value_title, .low = 0.0},
                  .layers = {{.shape = Shape::kBand, .role = Role::kInterval, .data = curve},
                             {.shape = Shape::kLine, .role = Role::kModel, .data = curve},
                             {.shape = Shape::kPoints, .role = Role::kMeasured, .data = points}}}}};
}

}  // namespace imunoise::report
