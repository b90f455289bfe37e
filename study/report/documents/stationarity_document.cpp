#include <fmt/format.h>

#include <utility>

#include "study/report/documents/inference_documents.h"
#include "study/report/documents/preflight_section.h"
#include "study/report/figures/interval_figure.h"
#include "study/report/view/verdict.h"
#include "study/words/number.h"

namespace imunoise::report {
namespace {

std::string probability(bool known, double p, Digits digits) {
  if (!known) return "–";
  return p < 1e-4 ? "< 0.0001" : number(p, 2, digits);
}

bool tested(const v1::TestResult& test) { return test.degrees_of_freedom() > 0; }

std::vector<std::string> row(const char* question, const v1::TestResult& test, Digits digits) {
  return {question,
          test.rejected() ? "yes"
          : tested(test)  ? "no"
                          : "not tested",
          probability(test.has_p_value(), test.p_value(), digits),
          probability(test.has_bootstrap_p_value(), test.bootstrap_p_value(), digits),
          number(test.statistic(), 4, digits),
          std::to_string(test.degrees_of_freedom())};
}

Table tests(const v1::StationarityReport& report, Digits digits) {
  Table out{"The two questions", {"", "", "p", "bootstrap", "statistic", "degrees"}, {}};
  out.rows.push_back(row("does the shape fail?", report.misfit(), digits));
  out.rows.push_back(row("do parameters differ?", report.heterogeneity(), digits));
  out.rows.push_back(
      {"published statistic", "", "",
       probability(report.has_published_p_value(), report.published_p_value(), digits),
       number(report.published_statistic(), 4, digits), ""});
  return out;
}

Table spread(const v1::StationarityReport& report, Digits digits) {
  Table out{"How parameters differ between replicates",
            {"parameter", "mean", "spread", "unit", "moves?", "p"},
            {}};
  for (const v1::ParameterSpread& one : report.spread()) {
    out.rows.push_back({one.term() + " " + one.parameter(), number(one.mean(), 4, digits),
                        with_interval(one.spread(), one.lower(), one.upper(), digits),
                        one.unit() == "1" ? "" : one.unit(), one.moves() ? "yes" : "not shown",
                        probability(one.has_p_value(), one.p_value(), digits)});
  }
  return out;
}

Section section(const v1::StationarityReport& report, Digits digits) {
  Section out;
  out.title = channel_name(report.channel());
  const bool misfit = report.misfit().rejected();
  const bool differ = report.heterogeneity().rejected();
  const bool both_tested = tested(report.misfit()) && tested(report.heterogeneity());
  out.badge = misfit && differ ? "misfit, and parameters differ"
              : misfit         ? "misfit"
              : differ         ? "parameters differ"
              : both_tested    ? "near-stationary"
                               : "not tested";
  out.mood = misfit        ? Mood::kBad
             : differ      ? Mood::kDoubtful
             : both_tested ? Mood::kGood
                           : Mood::kNeutral;
  out.facts = fmt::format("{} · {:g} Hz · {}", report.model(), report.rate_hz(),
                          counted(report.replicates(), "replicate")) +
              estimator_fact(report.estimator());
  if (report.bootstrap_sets() > 0) {
    out.facts +=
        fmt::format(" · {} bootstrap sets, seed {}", report.bootstrap_sets(), report.seed());
  }
  out.summary = report.summary();
  std::vector<IntervalRow> rows;
  for (const v1::ParameterSpread& one : report.spread()) {
    rows.push_back({one.term() + " " + one.parameter(), 100.0 * one.relative(),
                    100.0 * one.relative_lower(), 100.0 * one.relative_upper(), one.moves()});
  }
  auto figure = interval_figure(
      "Spread between replicates", "standard deviation between replicates, %",
      "Spread without the estimation error, with 95 % intervals; a line that "
      "reaches the left edge includes zero. Orange: significant. Parameters without "
      "excess spread are not shown.",
      rows, std::nullopt);
  if (figure) out.figures.push_back(std::move(*figure));
  out.tables = {tests(report, digits), spread(report, digits)};
  out.notes.assign(report.notes().begin(), report.notes().end());
  return out;
}

}  // namespace

Document document(const v1::StationarityReports& reports, Digits digits) {
  Document out{"near-stationarity", {}};
  for (const v1::StationarityReport& one : reports.channels()) {
    out.sections.push_back(section(one, digits));
  }
  if (reports.channels_size() > 0) add_files(reports.channels(0).preflight(), digits, out);
  return out;
}

}  // namespace imunoise::report
