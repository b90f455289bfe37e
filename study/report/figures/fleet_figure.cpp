#include "study/report/figures/fleet_figure.h"

#include <fmt/format.h>

namespace imunoise::report {
namespace {

// Its serial number where it is known.
std::string device_label(const v1::CataloguedDevice& device) {
  return device.serial().empty() ? device.id() : device.serial();
}

figure::State device_state(const v1::FleetDevice& one) {
  if (one.outlier()) return figure::State::kOutside;
  const bool seen = one.newest().has_lower() && one.newest().lower() > 0.0;
  return seen ? figure::State::kPlain : figure::State::kUntested;
}

}  // namespace

std::optional<figure::Figure> fleet_figure(const v1::FleetParameter& parameter) {
  const bool datasheet = !parameter.datasheet_unit().empty() && parameter.to_datasheet() > 0.0;
  const double factor = datasheet ? parameter.to_datasheet() : 1.0;
  figure::Panel panel{
      .x = {.kind = figure::AxisKind::kLogarithmic,
            .title = fmt::format("{}, {}", parameter.parameter(),
                                 datasheet ? parameter.datasheet_unit() : parameter.unit())},
      .y = {.kind = figure::AxisKind::kCategories}};
  if (parameter.has_median() && parameter.seen() > 1) {
    panel.x_reference = parameter.median() * factor;
    panel.layers.push_back({.shape = figure::Shape::kColumns,
                            .role = figure::Role::kInterval,
                            .data = {{.lower = parameter.lower_quartile() * factor,
                                      .upper = parameter.upper_quartile() * factor}}});
  }
  figure::Layer rows{.shape = figure::Shape::kIntervals, .role = figure::Role::kMeasured};
  for (const v1::FleetDevice& one : parameter.devices()) {
    const v1::HistoryPoint& newest = one.newest();
    if (!(newest.value() > 0.0)) continue;
    rows.data.push_back({.x = newest.value() * factor,
                         .y = static_cast<double>(panel.y.categories.size()),
                         .lower = newest.has_lower() ? newest.lower() * factor : figure::kUnknown,
                         .upper = newest.has_upper() ? newest.upper() * factor : figure::kUnknown,
                         .state = device_state(one)});
    panel.y.categories.push_back(device_label(one.device()));
  }
  if (rows.data.empty()) return std::nullopt;
  panel.layers.push_back(std::move(rows));
  const bool by_name = parameter.title().find(" of ") != std::string::npos;
  const std::string title =
      by_name ? parameter.title() : fmt::format("{} of {}", parameter.title(), parameter.term());
  return figure::Figure{
      .title = fmt::format("{}: {}", parameter.channel(), title),
      .caption =
          "A row a device: its newest calibration with the 95 % interval; hollow: only an "
          "upper bound. Line and band: median and quartiles of all. Orange: stands out.",
      .panels = {std::move(panel)}};
}

}  // namespace imunoise::report
