#include "study/report/fault_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "study/report/budget_layout.h"
#include "study/report/svg_plot.h"
#include "study/report/svg_writer.h"
#include "study/words/number.h"
#include "study/words/text.h"

namespace imunoise::report {
namespace {

constexpr double kRow = 64.0;   // px, of a sensor
constexpr double kName = 18.0;  // px, for its name above the row
constexpr double kFoot = 42.0;  // px, for the axis of time
constexpr double kSide = 10.0;  // px, left and right

using Traces = std::vector<const v1::ParityTrace*>;

struct Range {
  double low = 0.0;
  double high = 0.0;
};

Range range_of(const v1::ParityTrace& trace) {
  Range out;
  for (const double x : trace.low()) out.low = std::min(out.low, x);
  for (const double x : trace.high()) out.high = std::max(out.high, x);
  if (!(out.high > out.low)) out.high = out.low + 1.0;
  return out;
}

bool accuses(const v1::SensorFault& fault, const v1::ParityTrace& trace) {
  return fault.replicate() == trace.replicate() &&
         std::find(fault.sensors().begin(), fault.sensors().end(), trace.sensor()) !=
             fault.sensors().end();
}

void draw_row(SvgWriter& svg, const v1::FaultReport& report, const v1::ParityTrace& trace,
              const Box& frame, double seconds) {
  const auto x = [&](double t) {
    return frame.left + (frame.right - frame.left) * std::clamp(t / seconds, 0.0, 1.0);
  };
  const Range range = range_of(trace);
  const auto y = [&](double value) {
    return frame.bottom +
           (frame.top - frame.bottom) * (value - range.low) / (range.high - range.low);
  };
  const auto columns =
      static_cast<std::size_t>(0.5 * (frame.right - frame.left) / text_width("x", kTextSize));
  svg.text("key", {frame.left, frame.top - 6.0}, shorten(clean_text(trace.sensor()), columns),
           kTextSize, Anchor::kStart);
  svg.text("note", {frame.right, frame.top - 6.0},
           fmt::format("{} … {} {}", number(range.low, 2, Digits::kTypeset),
                       number(range.high, 2, Digits::kTypeset), report.unit()),
           kNoteSize, Anchor::kEnd);
  for (const double edge : {frame.top, frame.bottom}) {
    svg.line("grid", {frame.left, edge}, {frame.right, edge});
  }
  std::vector<Point> outline;
  for (int i = 0; i < trace.high_size(); ++i) {
    outline.push_back({x((i + 0.5) * trace.step_s()), y(trace.high(i))});
  }
  for (int i = trace.low_size(); i-- > 0;) {
    outline.push_back({x((i + 0.5) * trace.step_s()), y(trace.low(i)) + 1.0});
  }
  svg.path("band", outline, true);
  for (const v1::SensorFault& fault : report.faults()) {
    if (!accuses(fault, trace)) continue;
    const double at = x(fault.onset_s());
    svg.line("stem outside", {at, frame.top}, {at, frame.bottom});
    const bool left = at > 0.5 * (frame.left + frame.right);
    svg.text("label", {at + (left ? -6.0 : 6.0), frame.top + 13.0}, fault.kind(), kTextSize,
             left ? Anchor::kEnd : Anchor::kStart);
  }
}

std::string draw(const v1::FaultReport& report, const Traces& traces, const std::string& title,
                 const char* kind, double width) {
  const double bottom = (kRow + kName) * static_cast<double>(traces.size());
  const double seconds = traces.front()->step_s() * traces.front()->high_size();
  SvgWriter svg;
  svg.raw(page_opening(kind, width, bottom + kFoot, title));
  for (std::size_t i = 0; i < traces.size(); ++i) {
    const double top = (kRow + kName) * static_cast<double>(i) + kName;
    draw_row(svg, report, *traces[i], {kSide, top, width - kSide, top + kRow}, seconds);
  }
  for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const double x = kSide + share * (width - 2.0 * kSide);
    svg.line("axis", {x, bottom}, {x, bottom + 5.0});
    svg.text("tick", {x, bottom + 20.0}, share == 0.0 ? "0" : duration(share * seconds), kTickSize,
             share == 0.0   ? Anchor::kStart
             : share == 1.0 ? Anchor::kEnd
                            : Anchor::kMiddle);
  }
  svg.close("svg");
  return svg.str();
}

}  // namespace

std::optional<Figure> fault_chart(const v1::FaultReport& report, const std::string& replicate) {
  Traces traces;
  for (const v1::ParityTrace& trace : report.traces()) {
    if (trace.replicate() == replicate && trace.high_size() > 0 && trace.step_s() > 0.0)
      traces.push_back(&trace);
  }
  if (traces.empty()) return std::nullopt;
  const std::string title = clean_text(replicate) + ": each sensor against the mean of the others";
  return Figure{
      title, draw(report, traces, title, "wide", 920.0),
      draw(report, traces, title, "narrow", 388.0),
      "The smallest and largest difference in each part of the time, from its value at the "
      "beginning; every row has its own scale. Orange: when a fault of this sensor began. A "
      "fault of one sensor moves the others' rows a little the other way."};
}

}  // namespace imunoise::report
