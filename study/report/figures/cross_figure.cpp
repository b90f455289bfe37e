#include "study/report/figures/cross_figure.h"

#include <fmt/format.h>

#include <algorithm>

namespace imunoise::report {
namespace {

using figure::AxisKind;
using figure::Role;
using figure::Shape;

constexpr std::size_t kMostPanels = 24;

figure::Panel pair_panel(const v1::SensorPair& pair) {
  std::vector<figure::Datum> measured;
  std::vector<figure::Datum> model;
  for (const v1::CrossScale& scale : pair.scales()) {
    const bool outside = scale.model() < scale.lower() || scale.model() > scale.upper();
    measured.push_back({.x = scale.tau_s(),
                        .y = scale.covariance() / scale.unit(),
                        .lower = scale.lower() / scale.unit(),
                        .upper = scale.upper() / scale.unit(),
                        .state = outside ? figure::State::kOutside : figure::State::kPlain});
    model.push_back({.x = scale.tau_s(), .y = scale.model() / scale.unit()});
  }
  figure::Panel out{.title = pair.first() + ", " + pair.second(),
                    .x = {.kind = AxisKind::kLogarithmic, .title = "averaging time, s"},
                    .y = {.low = -1.0, .high = 1.0},
                    .height = 110.0};
  out.layers.push_back({.shape = Shape::kBand, .role = Role::kInterval, .data = measured});
  out.layers.push_back({.shape = Shape::kLine, .role = Role::kModel, .data = std::move(model)});
  for (figure::Datum& one : measured) one.lower = one.upper = figure::kUnknown;  // the band's
  out.layers.push_back(
      {.shape = Shape::kPoints, .role = Role::kMeasured, .data = std::move(measured)});
  return out;
}

}  // namespace

std::optional<figure::Figure> cross_figure(const v1::ArrayReport& report) {
  figure::Figure out{
      .title = "Shared noise of each pair of sensors",
      .caption =
          "Wavelet cross-covariance over averaging time, divided by the root of the two "
          "sensors' wavelet variances: 1 and −1 are noise that both share entirely. Dots "
          "and band: measured, with intervals made without the model; line: the model; "
          "orange: it lies outside the interval.",
      .sentence = "Wavelet cross-covariance of each pair of sensors",
      .columns = 3};
  const bool all = static_cast<std::size_t>(report.pairs_size()) <= kMostPanels;
  for (const v1::SensorPair& pair : report.pairs()) {
    const bool room = out.panels.size() < kMostPanels;
    if (pair.scales_size() > 1 && room && (all || pair.dependent()))
      out.panels.push_back(pair_panel(pair));
  }
  if (out.panels.empty()) return std::nullopt;
  out.columns = std::min(out.columns, out.panels.size());
  if (static_cast<int>(out.panels.size()) < report.pairs_size()) {
    out.caption += fmt::format(" Shown are {} of {} pairs, those that share noise.",
                               out.panels.size(), report.pairs_size());
  }
  return out;
}

}  // namespace imunoise::report
