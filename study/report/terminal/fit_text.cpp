#include "study/report/terminal/fit_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/figure/characters.h"
#include "study/report/documents/effect_rows.h"
#include "study/report/figures/budget_figure.h"
#include "study/report/terminal/lines.h"
#include "study/report/terminal/table.h"
#include "study/report/view/bias_instability.h"
#include "study/report/view/verdict.h"
#include "study/words/number.h"

namespace imunoise::report {
namespace {

constexpr Digits kPlainDigits = Digits::kPlain;

Ink ink_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kFits:
      return Ink::kGood;
    case Verdict::kDoubtful:
    case Verdict::kFails:
      return Ink::kAlarm;
    case Verdict::kUntested:
      break;
  }
  return Ink::kQuiet;
}

std::string marks(const TerminalStyle& style) {
  const std::string text = std::string(style.unicode ? "● measured, ◆ beyond 2 σ, ⠤ model"
                                                     : "o measured, x beyond 2 sd, . model") +
                           "; digits: residual in standard deviations, # above 9";
  return paragraph(text, Ink::kQuiet, style);
}

std::string coefficients(const v1::FitReport& report, const TerminalStyle& style) {
  std::vector<std::vector<std::string>> rows;
  for (const v1::Term& term : report.terms()) {
    for (const v1::Coefficient& c : term.coefficients()) {
      const bool sheet = !c.datasheet_unit().empty();
      rows.push_back({c.symbol(),
                      sheet ? with_interval(c.datasheet_value(), c.datasheet_lower(),
                                            c.datasheet_upper(), kPlainDigits)
                            : with_interval(c.value(), c.lower(), c.upper(), kPlainDigits),
                      sheet ? c.datasheet_unit() : c.unit(), c.title()});
    }
  }
  if (rows.empty()) return {};
  return "\n" + terminal_table({"", "coefficient", "unit", ""}, rows, style);
}

std::string instabilities(const v1::FitReport& report, const TerminalStyle& style) {
  std::vector<std::vector<std::string>> rows;
  for (const BiasInstability& one : bias_instabilities(report, kPlainDigits))
    rows.push_back({one.meaning, one.value, one.remark});
  if (rows.empty()) return {};
  return "\n" + terminal_table({"bias instability", "", ""}, rows, style);
}

std::string parameters(const v1::FitReport& report, const TerminalStyle& style) {
  const std::vector<std::string> names = budget_view(report).terms;
  std::vector<std::vector<std::string>> rows;
  for (std::size_t t = 0; t < names.size(); ++t) {
    const v1::Term& term = report.terms(static_cast<int>(t));
    for (const v1::Parameter& p : term.parameters()) {
      const bool bound = only_bounded(p) && p.upper() > 0.0;
      rows.push_back({names[t], p.name(),
                      bound ? "below " + number(p.upper(), 2, kPlainDigits)
                            : with_interval(p.value(), p.lower(), p.upper(), kPlainDigits),
                      p.unit() == "1" ? "" : p.unit(), observability_words(term, p)});
    }
  }
  if (rows.empty()) return {};
  return "\n" + terminal_table({"term", "parameter", "per sample", "unit", ""}, rows, style);
}

std::string effects(const v1::FitReport& report, const TerminalStyle& style) {
  if (report.effects().empty()) return {};
  return "\n" + terminal_table({"effect", "", "value"}, effect_rows(report.effects(), kPlainDigits),
                               style);
}

// The figure of a budget in characters, or that there is none.
std::string drawn(const figure::Figure& figure, const TerminalStyle& style) {
  const std::string out = characters(figure, style);
  return out.empty() ? wrapped("(nothing to draw: no positive variance)", 2, style) : out;
}

}  // namespace

std::string fit_text(const v1::FitReport& report, const TerminalStyle& wanted) {
  const TerminalStyle style = usable(wanted);
  const BudgetView view = budget_view(report);
  const Verdict v = verdict(report);
  std::string out = title_line(
      channel_name(report.channel()) + " " + std::string(verdict_words(v)) + ": " + facts(report),
      style);
  if (!report.summary().empty()) out += paragraph(report.summary(), Ink::kPlain, style);
  out += "\n" + drawn(budget_figure(report), style) + marks(style);
  out += "\n" + paragraph(verdict_sentence(report), ink_of(v), style);
  if (v == Verdict::kFails || v == Verdict::kDoubtful) {
    for (const Misfit& misfit : misfits(view)) out += wrapped(misfit_words(view, misfit), 2, style);
  }
  out += coefficients(report, style) + instabilities(report, style) + parameters(report, style) +
         effects(report, style);
  if (!report.notes().empty()) out += "\n";
  for (const std::string& note : report.notes()) out += wrapped("note: " + note, 0, style);
  return out;
}

std::string wv_text(const v1::WaveletVarianceReport& report, const TerminalStyle& wanted) {
  const TerminalStyle style = usable(wanted);
  const BudgetView view = budget_view(report);
  const AllanUnit allan = allan_unit(report.unit());
  std::vector<std::vector<std::string>> rows;
  for (const ScaleView& scale : view.scales) {
    rows.push_back({duration(scale.seconds),
                    with_interval(scale.measured, scale.lower, scale.upper, kPlainDigits),
                    duration(0.5 * scale.seconds),
                    number(allan.deviation(scale.measured), 3, kPlainDigits) + " " + allan.unit});
  }
  std::string out = title_line(fmt::format("{}: wavelet variance, {} estimator",
                                           channel_name(report.channel()), report.estimator()),
                               style);
  out += "\n" + drawn(budget_figure(view, {.unit = report.unit()}), style) + "\n";
  if (rows.empty()) return out;
  return out + terminal_table(
                   {"over", "variance, " + squared(report.unit()), "Allan tau", "Allan deviation"},
                   rows, style);
}

}  // namespace imunoise::report
