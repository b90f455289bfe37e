#include "study/figure/character_rows.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "study/words/number.h"
#include "study/words/text.h"

namespace imunoise::figure {
namespace {

using report::Ink;
using report::TerminalStyle;

constexpr double kLabelColumns = 10.0;
constexpr double kCertain = 3.0;  // σ from which a cell has a colour

struct Glyph {
  std::string text = " ";
  Ink ink = Ink::kPlain;
};

// One line of characters, written over from left to right.
class Row {
 public:
  Row(int columns, const TerminalStyle& style)
      : glyphs_(static_cast<std::size_t>(columns)), style_(style) {}

  std::size_t column(double share) const {
    const double last = static_cast<double>(glyphs_.size()) - 1.0;
    return static_cast<std::size_t>(
        std::clamp(share * static_cast<double>(glyphs_.size()), 0.0, last));
  }
  void put(std::size_t column, const std::string& unicode, const char* ascii, Ink ink) {
    glyphs_[column] = {style_.unicode ? unicode : ascii, ink};
  }
  std::string text() const {
    std::string out;
    for (const Glyph& one : glyphs_)
      out += one.text == " " ? " " : report::inked(one.text, one.ink, style_);
    return out;
  }

 private:
  std::vector<Glyph> glyphs_;
  TerminalStyle style_;
};

Ink ink_of(State state) { return state == State::kOutside ? Ink::kAlarm : Ink::kQuiet; }

std::string digit_of(double sigma) {
  const double size = std::round(std::abs(sigma));
  return size > 9.0 ? "#" : report::tick_label(size);
}

double place_or(const Scale& x, double value, double otherwise) {
  return has_place(x.kind(), value) ? x(value) : otherwise;
}

void put_interval(Row& row, const Scale& x, const Datum& one) {
  if (!has_place(x.kind(), one.x)) return;
  const std::size_t at = row.column(x(one.x));
  const std::size_t from = std::isnan(one.lower) ? at : row.column(place_or(x, one.lower, 0.0));
  const std::size_t to = std::isnan(one.upper) ? at : row.column(place_or(x, one.upper, 1.0));
  for (std::size_t c = from; c <= to; ++c) row.put(c, "─", "-", ink_of(one.state));
  row.put(at, "●", "o", one.state == State::kOutside ? Ink::kAlarm : Ink::kMeasured);
}

void put_bar(Row& row, const Scale& x, Role role, const Datum& one) {
  if (!has_place(x.kind(), one.x)) return;
  const std::size_t zero = row.column(place_or(x, 0.0, 0.0));
  const std::size_t at = row.column(x(one.x));
  const bool ghost = role == Role::kGhost;
  const Ink ink = ghost ? Ink::kQuiet : one.state == State::kOutside ? Ink::kAlarm : Ink::kMeasured;
  for (std::size_t c = std::min(zero, at); c <= std::max(zero, at); ++c)
    row.put(c, ghost ? "░" : "█", ghost ? ":" : "#", ink);
}

// A sign and a digit where they have room.
void put_cell(Row& row, const Scale& x, const Datum& one) {
  if (!std::isfinite(one.sigma) || !has_place(x.kind(), one.lower) ||
      !has_place(x.kind(), one.upper))
    return;
  const double middle = 0.5 * (x(one.lower) + x(one.upper));
  const Ink ink = std::abs(one.sigma) < kCertain ? Ink::kQuiet
                  : one.sigma > 0.0              ? Ink::kAlarm
                                                 : Ink::kModel;
  const std::size_t at = row.column(middle);
  const bool room = row.column(x(one.upper)) - row.column(x(one.lower)) > 2;
  if (room && at > 0 && std::abs(one.sigma) >= 0.5)
    row.put(at - 1, one.sigma > 0.0 ? "+" : "−", one.sigma > 0.0 ? "+" : "-", ink);
  const std::string digit = digit_of(one.sigma);
  row.put(at, digit, digit.c_str(), ink);
}

}  // namespace

std::string digit_row(const Panel& panel, const Scale& x, int columns, bool above,
                      const TerminalStyle& style) {
  std::vector<const Datum*> shown(static_cast<std::size_t>(columns), nullptr);
  Row row(columns, style);
  for (const Layer& layer : panel.layers) {
    if (layer.shape != Shape::kBars) continue;
    for (const Datum& one : layer.data) {
      if (!std::isfinite(one.y) || (one.y >= 0.0) != above || !has_place(x.kind(), one.x)) continue;
      const Datum*& best = shown[row.column(x(one.x))];
      if (best == nullptr || std::abs(one.y) > std::abs(best->y)) best = &one;
    }
  }
  for (std::size_t c = 0; c < shown.size(); ++c) {
    if (shown[c] == nullptr) continue;
    const std::string digit = digit_of(shown[c]->y);
    row.put(c, digit, digit.c_str(), ink_of(shown[c]->state));
  }
  return row.text();
}

std::string category_row(const Panel& panel, const Scale& x, std::size_t row, int columns,
                         const TerminalStyle& style) {
  Row out(columns, style);
  if (panel.x_reference && has_place(x.kind(), *panel.x_reference))
    out.put(out.column(x(*panel.x_reference)), "│", "|", Ink::kQuiet);
  for (const Layer& layer : panel.layers) {
    for (const Datum& one : layer.data) {
      if (one.y != static_cast<double>(row)) continue;
      if (layer.shape == Shape::kIntervals) put_interval(out, x, one);
      if (layer.shape == Shape::kBars) put_bar(out, x, layer.role, one);
      if (layer.shape == Shape::kCells) put_cell(out, x, one);
    }
  }
  return out.text();
}

std::string tick_row(const Scale& x, int columns, const TerminalStyle& style) {
  std::string out;
  for (const Tick& tick : x.ticks(columns, kLabelColumns, columns)) {
    if (!tick.major) continue;
    const std::string label = report::terminal_text(label_text(tick, style.unicode), style);
    const double half = x.kind() == AxisKind::kCategories
                            ? 0.5 * static_cast<double>(report::display_width(label))
                            : 0.0;
    const auto at = static_cast<std::size_t>(std::max(0.0, x(tick.value) * columns - half));
    const std::size_t used = report::display_width(out);
    if (at < used + (used > 0 ? 1 : 0) ||
        at + report::display_width(label) > static_cast<std::size_t>(columns))
      continue;
    out += std::string(at - used, ' ') + label;
  }
  return out;
}

}  // namespace imunoise::figure
