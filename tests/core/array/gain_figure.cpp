#include "tests/core/array/gain_figure.h"

#include <algorithm>
#include <cmath>

#include "study/figure/svg.h"

namespace imunoise::testing {
namespace {

using figure::AxisKind;
using figure::Layer;
using figure::Role;
using figure::Shape;

Layer predicted(const GainCurve& curve, std::size_t style, const std::string& key) {
  Layer out{.shape = Shape::kLine, .role = Role::kTerm, .style = style, .key = key};
  for (Eigen::Index j = 0; j < curve.predicted.size(); ++j)
    out.data.push_back({.x = static_cast<double>(j + 1), .y = curve.predicted(j)});
  return out;
}

Layer measured(const GainCurve& curve) {
  Layer out{
      .shape = Shape::kPoints, .role = Role::kMeasured, .key = "measured on held-out data, 95 %"};
  for (Eigen::Index j = 0; j < curve.measured.size(); ++j) {
    const double reach = std::exp(1.96 * curve.measured_error(j));
    out.data.push_back({.x = static_cast<double>(j + 1),
                        .y = curve.measured(j),
                        .lower = curve.measured(j) / reach,
                        .upper = curve.measured(j) * reach});
  }
  return out;
}

// All panels are read against each other: one range for all.
void share_range(std::vector<figure::Panel>& panels) {
  double low = 1.0;
  double high = 1.0;
  for (const figure::Panel& panel : panels) {
    for (const Layer& layer : panel.layers) {
      for (const figure::Datum& one : layer.data) {
        low = std::min({low, one.y, std::isfinite(one.lower) ? one.lower : one.y});
        high = std::max({high, one.y, std::isfinite(one.upper) ? one.upper : one.y});
      }
    }
  }
  for (figure::Panel& panel : panels) {
    panel.y.low = low / 1.1;
    panel.y.high = high * 1.1;
  }
}

}  // namespace

std::string gain_figure(const std::string& title, const std::vector<GainPanel>& panels) {
  figure::Figure out{.title = title,
                     .subtitle =
                         "Wavelet variance of the virtual sensor over that of the sensors' "
                         "mean: below 1 it is quieter.",
                     .columns = panels.size()};
  for (const GainPanel& panel : panels) {
    figure::Panel drawn{.title = panel.title,
                        .x = {.title = "scale"},
                        .y = {.kind = AxisKind::kLogarithmic},
                        .height = 250.0,
                        .y_reference = 1.0};
    for (std::size_t c = 0; c < panel.curves.size(); ++c) {
      const GainCurve& curve = panel.curves[c];
      drawn.layers.push_back(predicted(
          curve, c, panel.curves.size() > 1 ? "made for " + curve.name : "by the fitted model"));
      drawn.layers.push_back(measured(curve));
    }
    out.panels.push_back(std::move(drawn));
  }
  share_range(out.panels);
  return svg(out);
}

}  // namespace imunoise::testing
