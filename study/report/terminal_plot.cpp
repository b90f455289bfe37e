#include "study/report/terminal_plot.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "study/report/axis.h"
#include "study/report/terminal/table.h"
#include "study/words/number.h"
#include "study/words/text.h"

namespace imunoise::report {
namespace {

constexpr int kRows = 14;
constexpr int kMargin = 9;     // columns of the labels on the left
constexpr double kLabel = 10;  // columns that a label on the time axis needs

struct Axes {
  LogAxis time;      // columns
  LogAxis variance;  // rows, downwards
};

std::optional<Axes> plot_of(const BudgetView& view, int columns) {
  LogRange times;
  LogRange variances;
  for (const ScaleView& scale : view.scales) {
    times.include(scale.seconds);
    variances.include(scale.measured);
    variances.include(scale.model);
  }
  if (times.empty() || variances.empty()) return std::nullopt;
  return Axes{LogAxis(times.low() / 1.1, times.high() * 1.1, 0.0, columns),
              LogAxis(variances.low() / 1.3, variances.high() * 1.3, kRows, 0.0)};
}

Ink ink_of(const ScaleView& scale) { return scale.outside() ? Ink::kAlarm : Ink::kMeasured; }

std::string_view mark_of(const ScaleView& scale, const TerminalStyle& style) {
  if (scale.outside()) return style.unicode ? "◆" : "x";
  return style.unicode ? "●" : "o";
}

TerminalCanvas draw(const BudgetView& view, const Axes& plot, int columns,
                    const TerminalStyle& style) {
  TerminalCanvas canvas(columns, kRows, style);
  const double across = static_cast<double>(canvas.dots_across()) / columns;
  const double down = static_cast<double>(canvas.dots_down()) / kRows;
  const ScaleView* previous = nullptr;
  for (const ScaleView& scale : view.scales) {
    if (!drawable(scale.model)) continue;
    if (previous != nullptr) {
      canvas.line(plot.time(previous->seconds) * across, plot.variance(previous->model) * down,
                  plot.time(scale.seconds) * across, plot.variance(scale.model) * down);
    }
    previous = &scale;
  }
  for (const ScaleView& scale : view.scales) {
    if (!drawable(scale.measured)) continue;
    canvas.mark(plot.time(scale.seconds) * across, plot.variance(scale.measured) * down,
                mark_of(scale, style), ink_of(scale));
  }
  return canvas;
}

// Labels of the rows that decades fall into.
std::vector<std::string> row_labels(const Axes& plot, const TerminalStyle& style) {
  std::vector<std::string> out(kRows);
  for (const Tick& tick : plot.variance.decade_ticks(2.0)) {
    if (!tick.major) continue;
    const int exponent = static_cast<int>(std::lround(std::log10(tick.value)));
    const auto row = static_cast<std::size_t>(std::min(kRows - 1.0, plot.variance(tick.value)));
    out[row] = style.unicode ? "10" + superscript(exponent) : "1e" + std::to_string(exponent);
  }
  return out;
}

std::string left(const std::string& label, const char* axis) {
  const auto room = static_cast<std::size_t>(kMargin - 2);
  return std::string(room - std::min(room, display_width(label)), ' ') + label + " " + axis;
}

// Times under the decades of the axis.
std::string time_labels(const Axes& plot, int columns) {
  std::string out(kMargin, ' ');
  for (const Tick& tick : plot.time.decade_ticks(kLabel)) {
    if (!tick.major) continue;
    const std::string label = tick_label(tick.value) + " s";
    const auto at = static_cast<std::size_t>(kMargin + plot.time(tick.value));
    const std::size_t used = display_width(out);
    if (at < used || at + display_width(label) > static_cast<std::size_t>(kMargin + columns))
      continue;
    out += std::string(at - used, ' ') + label;
  }
  return out;
}

// One digit a scale, in the column of its point; where scales share a column the largest is kept.
std::string residual_row(const BudgetView& view, const Axes& plot, int columns, bool above,
                         const TerminalStyle& style) {
  std::vector<const ScaleView*> shown(static_cast<std::size_t>(columns), nullptr);
  for (const ScaleView& scale : view.scales) {
    if (!std::isfinite(scale.residual) || (scale.residual >= 0.0) != above) continue;
    const auto column = static_cast<std::size_t>(plot.time(scale.seconds));
    const ScaleView*& best = shown[std::min(column, shown.size() - 1)];
    if (best == nullptr || std::abs(scale.residual) > std::abs(best->residual)) best = &scale;
  }
  std::string out;
  for (const ScaleView* scale : shown) {
    if (scale == nullptr) {
      out += ' ';
      continue;
    }
    const double size = std::round(std::abs(scale->residual));
    const std::string digit = size > 9.0 ? "#" : tick_label(size);
    out += inked(digit, scale->outside() ? Ink::kAlarm : Ink::kQuiet, style);
  }
  return out;
}

}  // namespace

std::string terminal_plot(const BudgetView& view, bool residuals, const TerminalStyle& style) {
  const int columns = style.width - kMargin - 1;
  const std::optional<Axes> plot = plot_of(view, columns);
  if (!plot) return wrapped("(nothing to draw: no positive variance)", 2, style);
  const char* const axis = style.unicode ? "│" : "|";
  const std::vector<std::string> labels = row_labels(*plot, style);
  const std::vector<std::string> rows = draw(view, *plot, columns, style).lines();
  std::string out;
  for (std::size_t r = 0; r < rows.size(); ++r) out += left(labels[r], axis) + rows[r] + "\n";
  std::string line = left("", style.unicode ? "└" : "+");
  for (int c = 0; c < columns; ++c) line += style.unicode ? "─" : "-";
  out += line + "\n" + time_labels(*plot, columns) + "\n";
  if (residuals) {
    const std::string sigma = style.unicode ? "σ" : "sd";
    out += left("+" + sigma, axis) + residual_row(view, *plot, columns, true, style) + "\n";
    out += left("-" + sigma, axis) + residual_row(view, *plot, columns, false, style) + "\n";
  }
  return out;
}

}  // namespace imunoise::report
