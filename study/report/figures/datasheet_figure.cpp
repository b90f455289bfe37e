#include "study/report/figures/datasheet_figure.h"

#include <algorithm>

#include "study/report/figures/deviation_figure.h"
#include "study/report/view/budget_view.h"
#include "study/report/view/verdict.h"

namespace imunoise::report {

figure::Figure datasheet_figure(const v1::DatasheetReport& report) {
  const AllanUnit unit = allan_unit(report.unit());
  v1::DeviationReport measured = report.measured();
  measured.set_unit(report.unit());
  measured.set_kind("Allan");
  figure::Figure out = deviation_figure(measured);
  out.title =
      report.channel().empty() ? "Data sheet" : channel_name(report.channel()) + ": data sheet";
  out.caption = "Line: Allan deviation of the printed figures.";
  if (report.has_measured()) out.caption += " Points: measured, with intervals.";
  figure::Layer line{.shape = figure::Shape::kLine,
                     .role = figure::Role::kModel,
                     .name = "data sheet",
                     .key = "data sheet"};
  const bool any = measured.points_size() > 0;
  const double first = any ? measured.points(0).tau_s() : 0.0;
  const double last = any ? measured.points().rbegin()->tau_s() : figure::kUnknown;
  const int count = std::min(report.printed_tau_s_size(), report.printed_deviation_size());
  for (int i = 0; i < count; ++i) {
    const double tau = report.printed_tau_s(i);
    if (any && (tau < first || tau > last)) continue;
    line.data.push_back({.x = tau, .y = report.printed_deviation(i) * unit.factor});
  }
  out.panels.front().layers.push_back(std::move(line));
  return out;
}

}  // namespace imunoise::report
