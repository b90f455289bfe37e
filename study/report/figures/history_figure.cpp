#include "study/report/figures/history_figure.h"

#include <fmt/format.h>

namespace imunoise::report {
namespace {

using figure::kUnknown;
using figure::Role;
using figure::Shape;
using figure::State;

double seconds(const v1::HistoryPoint& point) {
  return 1e-9 * static_cast<double>(point.started_ns());
}

figure::Layer calibrations(const v1::ParameterHistory& history, double factor) {
  figure::Layer out{.shape = Shape::kPoints, .role = Role::kMeasured};
  for (const v1::HistoryPoint& one : history.points()) {
    out.data.push_back({.x = seconds(one),
                        .y = one.value() * factor,
                        .lower = one.has_lower() ? one.lower() * factor : kUnknown,
                        .upper = one.has_upper() ? one.upper() * factor : kUnknown,
                        .state = one.compared() ? State::kPlain : State::kUntested});
  }
  if (history.drift().newest_alarm()) out.data.back().state = State::kOutside;
  return out;
}

}  // namespace

std::string history_title(const v1::ParameterHistory& history) {
  const bool by_name = history.title().find(" of ") != std::string::npos;
  return fmt::format(
      "{}: {}", history.channel(),
      by_name ? history.title() : fmt::format("{} of {}", history.title(), history.term()));
}

ShownUnit shown_unit(const v1::ParameterHistory& history) {
  if (history.datasheet_unit().empty() || !(history.to_datasheet() > 0.0)) return {history.unit()};
  return {history.datasheet_unit(), history.to_datasheet()};
}

std::optional<figure::Figure> history_figure(const v1::ParameterHistory& history) {
  if (history.points_size() < 2 ||
      !(seconds(history.points(0)) < seconds(*history.points().rbegin())))
    return std::nullopt;
  const ShownUnit unit = shown_unit(history);
  figure::Figure out{
      .title = history_title(history),
      .caption =
          "Each dot is a calibration, at the start of its recording, with its 95 % interval; grey: "
          "not "
          "compared, because its model differs or it has only an upper bound.",
      .panels = {{.x = {.kind = figure::AxisKind::kTime},
                  .y = {.title = fmt::format("{}, {}", history.parameter(), unit.name)},
                  .height = 220.0,
                  .layers = {calibrations(history, unit.factor)}}}};
  if (history.has_drift()) {
    out.caption += " Band: where the newest calibration raises no alarm. Orange: an alarm.";
    out.panels[0].layers.push_back(
        {.shape = Shape::kRows,
         .role = Role::kInterval,
         .data = {{.lower = history.drift().expected_lower() * unit.factor,
                   .upper = history.drift().expected_upper() * unit.factor}}});
  }
  return out;
}

}  // namespace imunoise::report
