#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/figure/svg.h"
#include "tests/core/inference/power_curve.h"

namespace imunoise::testing {
namespace {

using figure::Layer;
using figure::Role;
using figure::Shape;

Layer share_of(const PowerCurve& curve, double PowerPoint::*share, Layer out) {
  for (std::size_t k = 0; k < curve.points.size(); ++k)
    out.data.push_back({.x = static_cast<double>(k), .y = 100.0 * (curve.points[k].*share)});
  return out;
}

// Measured shares, with 95 % of what chance does to them.
Layer measured(const PowerCurve& curve) {
  Layer out = share_of(
      curve, &PowerPoint::heterogeneity,
      {.shape = Shape::kPoints, .role = Role::kMeasured, .key = "heterogeneity, measured"});
  for (figure::Datum& one : out.data) {
    const double p = 0.01 * one.y;
    const double reach = 196.0 * std::sqrt(p * (1.0 - p) / static_cast<double>(curve.sets));
    one.lower = std::max(0.0, one.y - reach);
    one.upper = std::min(100.0, one.y + reach);
  }
  return out;
}

// The spreads are the steps of a trial, "no spread" first: places in a row.
figure::Panel power_panel(const PowerCurve& curve) {
  figure::Panel out{.title = fmt::format("{}: {} differs", curve.title, curve.moves),
                    .x = {.kind = figure::AxisKind::kCategories,
                          .title = fmt::format("spread of {}, %", curve.moves)},
                    .y = {.low = 0.0, .high = 100.0},
                    .height = 220.0};
  for (const PowerPoint& point : curve.points)
    out.x.categories.push_back(fmt::format("{:g}", 100.0 * point.spread));
  out.layers = {
      share_of(curve, &PowerPoint::misfit,
               {.shape = Shape::kLine, .role = Role::kTerm, .style = 0, .key = "misfit"}),
      share_of(
          curve, &PowerPoint::published,
          {.shape = Shape::kLine, .role = Role::kTerm, .style = 1, .key = "published statistic"}),
      share_of(curve, &PowerPoint::predicted,
               {.shape = Shape::kLine, .role = Role::kModel, .key = "heterogeneity, theory"}),
      measured(curve)};
  return out;
}

}  // namespace

std::string power_figure(const std::vector<PowerCurve>& curves) {
  figure::Figure out{.title = "How often each test rejects, %",
                     .sentence = "Power of the tests of near-stationarity",
                     .columns = curves.size()};
  for (const PowerCurve& curve : curves) out.panels.push_back(power_panel(curve));
  return svg(out);
}

}  // namespace imunoise::testing
