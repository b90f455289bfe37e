#include "study/report/history_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/report/axis.h"
#include "study/report/budget_layout.h"
#include "study/report/svg_plot.h"
#include "study/report/svg_writer.h"
#include "study/words/number.h"
#include "study/words/text.h"

namespace imunoise::report {
namespace {

constexpr double kLeft = 70.0;    // px, for the labels of the vertical axis
constexpr double kRight = 40.0;   // px, for half of the last date
constexpr double kTop = 30.0;     // px, for the title of the vertical axis
constexpr double kFrame = 220.0;  // px, height of the frame
constexpr double kFoot = 30.0;    // px, for the dates
constexpr double kMostRoom =
    4.0;  // the frame, over the range of the values: wider intervals are cut

struct Frame {
  double low = 1e300;
  double high = -1e300;
  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

// The values, and of the intervals and the expected range what leaves the values legible.
Frame frame_of(const v1::ParameterHistory& history) {
  Frame values;
  Frame all;
  for (const v1::HistoryPoint& one : history.points()) {
    values.include(one.value());
    all.include(one.value());
    if (one.has_lower()) all.include(one.lower());
    if (one.has_upper()) all.include(one.upper());
  }
  if (history.has_drift()) {
    all.include(history.drift().expected_lower());
    all.include(history.drift().expected_upper());
  }
  const double range = std::max(values.high - values.low, 0.02 * std::abs(values.high));
  const double room = 0.5 * (kMostRoom - 1.0) * range;
  Frame out{std::max(all.low, values.low - room), std::min(all.high, values.high + room)};
  const double margin = 0.06 * (out.high - out.low) + (out.high > out.low ? 0.0 : 1.0);
  return {std::max(values.low > 0.0 ? 0.0 : out.low - margin, out.low - margin), out.high + margin};
}

double days(const v1::HistoryPoint& point) {
  return static_cast<double>(point.started_ns()) / 86400e9;
}

class Plot {
 public:
  Plot(const v1::ParameterHistory& history, double width)
      : history_(history),
        unit_(shown_unit(history)),
        frame_{kLeft, kTop, width - kRight, kTop + kFrame},
        across_(days(history.points(0)), days(*history.points().rbegin()), frame_.left + 10.0,
                frame_.right - 10.0),
        up_(low_of(history) * unit_.factor, high_of(history) * unit_.factor, frame_.bottom,
            frame_.top) {}

  std::string draw(const char* kind, double width) const {
    SvgWriter svg;
    svg.raw(page_opening(kind, width, frame_.bottom + kFoot, history_title(history_)));
    draw_expected(svg);
    draw_axes(svg);
    for (int i = 0; i < history_.points_size(); ++i) draw_point(svg, i);
    svg.close("svg");
    return svg.str();
  }

 private:
  static double low_of(const v1::ParameterHistory& history) { return frame_of(history).low; }
  static double high_of(const v1::ParameterHistory& history) { return frame_of(history).high; }

  double height(double value) const {
    return std::clamp(up_(value * unit_.factor), frame_.top, frame_.bottom);
  }

  void draw_expected(SvgWriter& svg) const {
    if (!history_.has_drift()) return;
    svg.rect("band", {frame_.left, height(history_.drift().expected_upper()), frame_.right,
                      height(history_.drift().expected_lower())});
  }

  void draw_axes(SvgWriter& svg) const {
    for (const double value : up_.ticks(40.0)) {
      svg.line("grid", {frame_.left, up_(value)}, {frame_.right, up_(value)});
      const double size = std::abs(value);
      const std::string label = size == 0.0 || (size >= 1e-3 && size < 1e5)
                                    ? tick_label(value)
                                    : number(value, 3, Digits::kTypeset);
      svg.text("tick", {frame_.left - 8.0, up_(value) + 4.0}, label, kTickSize, Anchor::kEnd);
    }
    svg.line("axis", {frame_.left, frame_.bottom}, {frame_.right, frame_.bottom});
    for (const double value : across_.ticks(100.0)) {
      if (value != std::floor(value)) continue;  // a label is a whole day
      svg.line("axis", {across_(value), frame_.bottom}, {across_(value), frame_.bottom + 5.0});
      svg.text("tick", {across_(value), frame_.bottom + 20.0},
               day(static_cast<std::int64_t>(value) * 86'400'000'000'000), kTickSize,
               Anchor::kMiddle);
    }
    const std::string title = fmt::format("{}, {}", history_.parameter(), unit_.name);
    svg.text("axis-title", {4.0, frame_.top - 12.0}, clean_text(title), kTextSize, Anchor::kStart);
  }

  void draw_point(SvgWriter& svg, int index) const {
    const v1::HistoryPoint& point = history_.points(index);
    const bool accused = index + 1 == history_.points_size() && history_.drift().alarm();
    const double x = across_(days(point));
    const double lower = point.has_lower() ? height(point.lower()) : frame_.bottom;
    const double upper = point.has_upper() ? height(point.upper()) : frame_.top;
    svg.line(accused ? "stem outside" : "whisker", {x, lower}, {x, upper});
    svg.circle(accused            ? "measured outside"
               : point.compared() ? "measured"
                                  : "measured untested",
               {x, height(point.value())}, 4.0);
  }

  const v1::ParameterHistory& history_;
  ShownUnit unit_;
  Box frame_;
  LinearAxis across_;
  LinearAxis up_;
};

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

std::optional<Figure> history_chart(const v1::ParameterHistory& history) {
  if (history.points_size() < 2 || !(days(history.points(0)) < days(*history.points().rbegin())))
    return std::nullopt;
  std::string caption =
      "A dot a calibration, at the start of its recording, with its 95 % interval; grey: not "
      "compared, because its model is another one or only an upper bound is known.";
  if (history.has_drift())
    caption += " The band: where the newest calibration raises no alarm. Orange: it does.";
  return Figure{history_title(history), Plot(history, 920.0).draw("wide", 920.0),
                Plot(history, 388.0).draw("narrow", 388.0), caption};
}

}  // namespace imunoise::report
