#include <fmt/format.h>

#include <utility>

#include "study/report/documents/array_tables.h"
#include "study/report/documents/inference_documents.h"
#include "study/report/documents/preflight_section.h"
#include "study/report/view/verdict.h"

namespace imunoise::report {
namespace {

std::vector<std::string> row_of(const std::string& regressor, const std::string& method,
                                const v1::CoefficientEstimate& one, const std::string& unit,
                                Digits digits) {
  return {regressor,
          method,
          rounded(one.value(), one.lower(), one.upper(), digits),
          interval(one.value(), one.lower(), one.upper(), digits),
          unit,
          one.p_value() < 1e-4 ? "< 0.0001" : number(one.p_value(), 2, digits)};
}

Table coefficients(const v1::MixedReport& report, Digits digits) {
  Table out{"Coefficients", {"regressor", "method", "value", "interval", "unit", "p"}, {}};
  for (const v1::RegressionCoefficient& one : report.coefficients()) {
    out.rows.push_back(
        row_of(one.regressor(), "GLS under the noise", one.gls(), one.unit(), digits));
    if (one.has_robust())
      out.rows.push_back(row_of("", "robust (Huber)", one.robust(), one.unit(), digits));
    out.rows.push_back(row_of("", "as if independent", one.naive(), one.unit(), digits));
  }
  return out;
}

Table constants(const v1::MixedReport& report, Digits digits) {
  Table out{"Constants, at the first sample of all regressors", {"series", "value", "unit"}, {}};
  for (const v1::SeriesConstant& one : report.constants())
    out.rows.push_back(
        {one.series(), number(one.value(), 6, digits), report.unit() == "1" ? "" : report.unit()});
  return out;
}

}  // namespace

Document document(const v1::MixedReport& report, Digits digits) {
  Section section;
  bool effect = false;
  for (const v1::RegressionCoefficient& one : report.coefficients()) {
    section.title += (section.title.empty() ? "" : ", ") + one.regressor();
    effect = effect || one.significant();
  }
  section.badge = effect ? "effect" : "no effect shown";
  section.mood = effect ? Mood::kGood : Mood::kNeutral;
  section.facts =
      fmt::format("{} · {:g} Hz · {} series of {} samples · {}{}", report.model(), report.rate_hz(),
                  report.series_size(), report.samples(),
                  report.termination() + estimator_fact(report.estimator()),
                  report.bootstraps() > 0
                      ? fmt::format(" · {} bootstraps, seed {}", report.bootstraps(), report.seed())
                      : "");
  section.summary = report.summary();
  section.tables = {
      coefficients(report, digits),
      sensor_budgets("What explains the variance of each series", "series", report.explained()),
      array_parameters("Parameters of the noise", report.parameters(), digits),
      constants(report, digits)};
  if (Table shown = array_correlations(report.parameters(), digits); !shown.rows.empty())
    section.tables.push_back(std::move(shown));
  section.notes.assign(report.notes().begin(), report.notes().end());
  Document out{"mixed", {std::move(section)}};
  add_files(report.preflight(), digits, out);
  return out;
}

}  // namespace imunoise::report
