#include "study/report/documents/datasheet_document.h"

#include <fmt/format.h>

#include <algorithm>

#include "study/report/documents/preflight_section.h"
#include "study/report/figures/datasheet_figure.h"
#include "study/report/view/verdict.h"

namespace imunoise::report {
namespace {

std::string change_words(const v1::DatasheetFigure& figure) {
  if (!figure.has_measured()) return "";
  return fmt::format("{:+.0f} %", 100.0 * (figure.measured() / figure.value() - 1.0));
}

std::vector<std::string> row_of(const v1::DatasheetFigure& figure, Digits digits) {
  const double factor = figure.datasheet_value() / figure.value();
  return {figure.symbol(),
          figure.title(),
          number(figure.datasheet_value(), 3, digits) + " " + figure.datasheet_unit(),
          figure.has_measured() ? with_interval(figure.measured() * factor, figure.lower() * factor,
                                                figure.upper() * factor, digits)
                                : "",
          figure.has_tau_s() ? duration(figure.tau_s()) : "",
          change_words(figure),
          figure.verdict()};
}

bool any(const v1::DatasheetReport& report, std::string_view verdict) {
  return std::any_of(report.figures().begin(), report.figures().end(),
                     [&](const v1::DatasheetFigure& one) { return one.verdict() == verdict; });
}

// Where no figure was seen, none is met.
void add_verdict(const v1::DatasheetReport& report, Section& to) {
  if (!report.has_measured()) return;
  to.badge = any(report, "missed") ? "missed" : any(report, "met") ? "met" : "not seen";
  to.mood = to.badge == "missed" ? Mood::kBad : to.badge == "met" ? Mood::kGood : Mood::kNeutral;
}

Section section_of(const v1::DatasheetReport& report, Digits digits) {
  Section out;
  out.title = report.channel().empty() ? "Printed figures" : channel_name(report.channel());
  add_verdict(report, out);
  out.facts = fmt::format("{} at {:g} Hz", report.model(), report.rate_hz());
  out.summary = report.summary();
  out.panel = datasheet_figure(report);
  Table table{"Figures", {"", "figure", "printed", "measured", "at τ", "difference", ""}, {}};
  for (const v1::DatasheetFigure& one : report.figures()) table.rows.push_back(row_of(one, digits));
  out.tables.push_back(std::move(table));
  return out;
}

}  // namespace

Document document(const v1::DatasheetReports& reports, Digits digits) {
  Document out{"data sheet", {}};
  for (const v1::DatasheetReport& one : reports.channels())
    out.sections.push_back(section_of(one, digits));
  if (reports.channels_size() > 0)
    add_files(reports.channels(0).measured().preflight(), digits, out);
  return out;
}

}  // namespace imunoise::report
