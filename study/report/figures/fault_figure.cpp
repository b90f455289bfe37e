#include "study/report/figures/fault_figure.h"

#include <algorithm>

#include "study/words/text.h"

namespace imunoise::report {
namespace {

using figure::AxisKind;
using figure::Role;
using figure::Shape;

bool accuses(const v1::SensorFault& fault, const v1::ParityTrace& trace) {
  return fault.replicate() == trace.replicate() &&
         std::find(fault.sensors().begin(), fault.sensors().end(), trace.sensor()) !=
             fault.sensors().end();
}

figure::Panel sensor_panel(const v1::FaultReport& report, const v1::ParityTrace& trace) {
  figure::Layer extent{.shape = Shape::kBand, .role = Role::kMeasured, .name = trace.sensor()};
  for (int i = 0; i < std::min(trace.low_size(), trace.high_size()); ++i) {
    extent.data.push_back(
        {.x = (i + 0.5) * trace.step_s(), .lower = trace.low(i), .upper = trace.high(i)});
  }
  const double seconds = trace.step_s() * trace.high_size();
  figure::Layer onsets{.shape = Shape::kMarks, .role = Role::kMisfit};
  for (const v1::SensorFault& fault : report.faults()) {
    if (!accuses(fault, trace)) continue;
    onsets.data.push_back({.x = std::clamp(fault.onset_s(), 0.0, seconds),
                           .state = figure::State::kOutside,
                           .words = fault.kind()});
  }
  return {.title = trace.sensor(),
          .note = report.unit() == "1" ? "" : report.unit(),
          .x = {.kind = AxisKind::kDuration,
                .title = "time since the start of the replicate",
                .low = 0.0,
                .high = seconds},
          .height = 72.0,
          .layers = {std::move(extent), std::move(onsets)}};
}

}  // namespace

std::optional<figure::Figure> fault_figure(const v1::FaultReport& report,
                                           const std::string& replicate) {
  figure::Figure out{
      .title = clean_text(replicate) + ": each sensor against the mean of the others",
      .caption =
          "Smallest and largest difference in each interval of time, relative to its value at the "
          "start; each row has its own scale. Orange: start of a fault of this sensor. A "
          "fault of one sensor moves the rows of the others slightly the other way."};
  for (const v1::ParityTrace& trace : report.traces()) {
    if (trace.replicate() != replicate || trace.high_size() == 0 || !(trace.step_s() > 0.0))
      continue;
    out.panels.push_back(sensor_panel(report, trace));
    out.panels.back().shares_x = out.panels.size() > 1;
  }
  return figure::unless_empty(std::move(out));
}

}  // namespace imunoise::report
