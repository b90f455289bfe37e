#include "study/report/documents/deviation_document.h"

#include <fmt/format.h>

#include "study/report/documents/preflight_section.h"
#include "study/report/figures/deviation_figure.h"
#include "study/report/view/budget_view.h"
#include "study/report/view/verdict.h"
#include "study/words/number.h"

namespace imunoise::report {
namespace {

std::string minimum_words(const v1::DeviationReport& report, Digits digits) {
  const v1::DeviationMinimum& minimum = report.minimum();
  const AllanUnit unit = allan_unit(report.unit());
  std::string out =
      fmt::format("Minimum {} {} at {}", number(minimum.deviation() * unit.factor, 3, digits),
                  unit.unit, duration(minimum.tau_s()));
  if (report.kind() == "Allan")
    out += fmt::format("; bias instability (minimum / 0.664) {} {}",
                       number(minimum.bias_instability() * unit.factor, 3, digits), unit.unit);
  if (minimum.at_edge())
    out += ". The minimum is at the longest averaging time: record longer to find it";
  return out + ".";
}

Section section_of(const v1::DeviationReport& report, Digits digits) {
  const AllanUnit unit = allan_unit(report.unit());
  Section out;
  out.title = fmt::format("{}: {} deviation", channel_name(report.channel()), report.kind());
  out.facts = fmt::format("overlapping · {:g} Hz · {}", report.rate_hz(),
                          counted(report.replicates(), "replicate"));
  out.summary = minimum_words(report, digits);
  out.panel = deviation_figure(report);
  Table table{
      "Deviation", {"τ", "samples", "deviation, " + unit.unit, "degrees of freedom", "noise"}, {}};
  for (const v1::DeviationPoint& one : report.points()) {
    table.rows.push_back({duration(one.tau_s()), count(one.samples(), digits),
                          with_interval(one.deviation() * unit.factor, one.lower() * unit.factor,
                                        one.upper() * unit.factor, digits),
                          number(one.degrees_of_freedom(), 3, digits), one.noise()});
  }
  out.tables.push_back(std::move(table));
  return out;
}

}  // namespace

Document document(const v1::DeviationReports& reports, Digits digits) {
  Document out{"deviations", {}};
  for (const v1::DeviationReport& one : reports.channels())
    out.sections.push_back(section_of(one, digits));
  if (reports.channels_size() > 0) add_files(reports.channels(0).preflight(), digits, out);
  return out;
}

}  // namespace imunoise::report
