#include "study/report/figures/virtual_sensor_figures.h"

#include <fmt/format.h>

namespace imunoise::report {
namespace {

using figure::AxisKind;
using figure::Role;
using figure::Shape;
using figure::State;

}  // namespace

std::optional<figure::Figure> gain_figure(const v1::VirtualSensor& sensor) {
  figure::Layer predicted{
      .shape = Shape::kLine, .role = Role::kModel, .name = "by the model", .key = "by the model"};
  figure::Layer measured{.shape = Shape::kPoints,
                         .role = Role::kMeasured,
                         .name = "on held-out replicates",
                         .key = "on held-out replicates"};
  for (const v1::ScaleGain& one : sensor.scale_gains()) {
    predicted.data.push_back({.x = one.tau_s(), .y = one.predicted()});
    if (!one.has_measured()) continue;
    measured.data.push_back({.x = one.tau_s(),
                             .y = one.measured(),
                             .state = one.measured() > 1.0 ? State::kOutside : State::kPlain});
  }
  if (predicted.data.size() < 2) return std::nullopt;
  return figure::Figure{
      .title = "Gain of the virtual sensor",
      .caption =
          "Below 1, the virtual sensor is quieter than the mean of all sensors; orange: "
          "noisier than it on held-out replicates.",
      .sentence = "Wavelet variance of the virtual sensor relative to the mean of the sensors",
      .panels = {{.x = {.kind = AxisKind::kLogarithmic, .title = "averaging time, s"},
                  .y = {.kind = AxisKind::kLogarithmic,
                        .title = "wavelet variance over that of the mean",
                        .short_title = "variance / mean's"},
                  .height = 260.0,
                  .y_reference = 1.0,
                  .layers = {std::move(predicted), std::move(measured)}}},
      .cursor = true};
}

std::optional<figure::Figure> weights_figure(const v1::VirtualSensor& sensor) {
  constexpr double kReach = 1.96;  // standard errors of a 95 % interval
  figure::Panel panel{.x = {.kind = AxisKind::kLinear, .title = "weight"},
                      .y = {.kind = AxisKind::kCategories},
                      .x_reference = 0.0};
  figure::Layer rows{.shape = Shape::kIntervals, .role = Role::kMeasured};
  for (const v1::SensorWeight& one : sensor.weights()) {
    const double reach = one.has_standard_error() ? kReach * one.standard_error() : 0.0;
    rows.data.push_back({.x = one.weight(),
                         .y = static_cast<double>(panel.y.categories.size()),
                         .lower = one.weight() - reach,
                         .upper = one.weight() + reach});
    panel.y.categories.push_back(one.sensor());
  }
  panel.layers = {std::move(rows)};
  return figure::unless_empty({.title = "Weights of the virtual sensor",
                               .caption = "Each sensor's weight with its 95 % interval.",
                               .panels = {std::move(panel)}});
}

std::optional<figure::Figure> correlations_figure(const v1::ArrayReport& report) {
  figure::Panel panel{
      .x = {.kind = AxisKind::kLinear, .title = "correlation", .low = -1.0, .high = 1.0},
      .y = {.kind = AxisKind::kCategories},
      .x_reference = 0.0};
  figure::Layer rows{.shape = Shape::kIntervals, .role = Role::kMeasured};
  for (const v1::ArrayParameter& one : report.parameters()) {
    if (!one.has_correlation() || one.sensors_size() < 2) continue;
    const bool shared = one.has_correlation_lower() &&
                        (one.correlation_lower() > 0.0 || one.correlation_upper() < 0.0);
    rows.data.push_back(
        {.x = one.correlation(),
         .y = static_cast<double>(panel.y.categories.size()),
         .lower = one.has_correlation_lower() ? one.correlation_lower() : figure::kUnknown,
         .upper = one.has_correlation_upper() ? one.correlation_upper() : figure::kUnknown,
         .state = shared ? State::kOutside : State::kPlain});
    panel.y.categories.push_back(
        fmt::format("{}: {}, {}", one.term(), one.sensors(0), one.sensors(1)));
  }
  panel.layers = {std::move(rows)};
  return figure::unless_empty(
      {.title = "Correlation of each process between sensors",
       .caption = "With 95 % intervals. Orange: the interval excludes zero, so that the sensors "
                  "share this process.",
       .panels = {std::move(panel)}});
}

}  // namespace imunoise::report
