#include "study/report/figures/deviation_figure.h"

#include <fmt/format.h>

#include "study/report/view/budget_view.h"
#include "study/report/view/verdict.h"

namespace imunoise::report {

figure::Figure deviation_figure(const v1::DeviationReport& report) {
  using figure::AxisKind;
  const AllanUnit unit = allan_unit(report.unit());
  figure::Layer band{.shape = figure::Shape::kBand, .role = figure::Role::kInterval};
  figure::Layer points{
      .shape = figure::Shape::kPoints, .role = figure::Role::kMeasured, .name = "measured"};
  for (const v1::DeviationPoint& one : report.points()) {
    const figure::Datum datum{.x = one.tau_s(),
                              .y = one.deviation() * unit.factor,
                              .lower = one.lower() * unit.factor,
                              .upper = one.upper() * unit.factor};
    band.data.push_back(datum);
    points.data.push_back(datum);
  }
  const std::string what = report.kind() + " deviation";
  return {.title = fmt::format("{}: {}", channel_name(report.channel()), what),
          .caption = fmt::format("Overlapping {}, with {:g} % intervals.", what,
                                 100.0 * report.confidence()),
          .panels = {{.x = {.kind = AxisKind::kLogarithmic, .title = "averaging time τ, s"},
                      .y = {.kind = AxisKind::kLogarithmic,
                            .title = fmt::format("{}, {}", what, unit.unit),
                            .short_title = unit.unit},
                      .height = 360.0,
                      .layers = {std::move(band), std::move(points)}}}};
}

}  // namespace imunoise::report
