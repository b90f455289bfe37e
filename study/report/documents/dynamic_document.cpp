#include <fmt/format.h>

#include "study/report/documents/inference_documents.h"
#include "study/report/documents/preflight_section.h"
#include "study/report/figures/covariate_figure.h"
#include "study/report/view/verdict.h"
#include "study/words/number.h"

namespace imunoise::report {
namespace {

std::string in_unit(const std::string& name, const std::string& unit) {
  return unit.empty() || unit == "1" ? name : name + ", " + unit;
}

std::string covariate_title(const v1::DynamicReport& report) {
  return in_unit(report.covariate(), report.covariate_unit());
}

std::string name_of(const v1::DynamicQuantity& quantity) {
  return quantity.symbol() + " of " + quantity.term();
}

std::string probability(const v1::TestResult& test, Digits digits) {
  if (!test.has_p_value()) return "–";
  return test.p_value() < 1e-4 ? "< 0.0001" : number(test.p_value(), 2, digits);
}

CovariateValue covariate_value(const v1::CovariatePoint& from) {
  return {from.covariate(), from.value(), from.has_lower() ? from.lower() : kMissing,
          from.has_upper() ? from.upper() : kMissing};
}

std::string value_words(const v1::CovariatePoint& point, Digits digits) {
  if (!point.has_upper()) return number(point.value(), 3, digits);
  if (!(point.lower() > 0.0) && point.value() < point.upper()) {
    return "< " + number(point.upper(), 2, digits);
  }
  return with_interval(point.value(), point.lower(), point.upper(), digits);
}

std::optional<figure::Figure> figure_of(const v1::DynamicReport& report,
                                        const v1::DynamicQuantity& quantity) {
  CovariateValues chart;
  chart.title = name_of(quantity) + ": " + quantity.title();
  chart.covariate_title = covariate_title(report);
  chart.value_title = in_unit(name_of(quantity), quantity.unit());
  chart.caption = fmt::format(
      "Line: the fit of all bins together, in its {:g} % band. Circles: each bin fitted by itself, "
      "with its interval; grey where only the upper end means something. Where those intervals "
      "miss the band, the link is wrong.",
      100.0 * report.confidence());
  for (const v1::CovariatePoint& one : quantity.curve())
    chart.curve.push_back(covariate_value(one));
  for (const v1::CovariatePoint& one : quantity.separate()) {
    chart.points.push_back(covariate_value(one));
  }
  return covariate_figure(chart);
}

const v1::CovariatePoint* at(const google::protobuf::RepeatedPtrField<v1::CovariatePoint>& points,
                             double covariate) {
  for (const v1::CovariatePoint& one : points) {
    if (one.covariate() == covariate) return &one;
  }
  return nullptr;
}

Table values(const v1::DynamicReport& report, const v1::DynamicQuantity& quantity, Digits digits) {
  Table out{in_unit(name_of(quantity), quantity.unit()),
            {report.covariate(), "all bins together", "this bin by itself"},
            {}};
  for (const v1::CovariatePoint& one : quantity.bins()) {
    const v1::CovariatePoint* const alone = at(quantity.separate(), one.covariate());
    out.rows.push_back({number(one.covariate(), 4, digits), value_words(one, digits),
                        alone == nullptr ? "–" : value_words(*alone, digits)});
  }
  return out;
}

// What does not follow the covariate is said once.
Table constants(const v1::DynamicReport& report, Digits digits) {
  Table out{"What is the same everywhere", {"", "value", "unit"}, {}};
  for (const v1::DynamicQuantity& one : report.quantities()) {
    if (one.varies() || one.bins().empty()) continue;
    out.rows.push_back({name_of(one), value_words(one.bins(0), digits), one.unit()});
  }
  return out;
}

Table trends(const v1::DynamicReport& report, Digits digits) {
  Table out{"What follows " + covariate_title(report),
            {"parameter", "as", "follows?", "p", "at the lowest", "at the highest", "unit"},
            {}};
  for (const v1::ParameterTrend& one : report.trends()) {
    out.rows.push_back({one.term() + " " + one.parameter(), one.link(),
                        one.test().rejected() ? "yes" : "not shown",
                        probability(one.test(), digits), number(one.first().value(), 3, digits),
                        number(one.last().value(), 3, digits),
                        one.unit() == "1" ? "" : one.unit()});
  }
  return out;
}

Table bins(const v1::DynamicReport& report, Digits digits) {
  Table out{"Bins", {report.covariate(), "from", "to", "samples", "runs", "fits?", "p"}, {}};
  for (const v1::DynamicBin& one : report.bins()) {
    const bool tested = one.misfit().degrees_of_freedom() > 0;
    out.rows.push_back({number(one.covariate(), 4, digits), number(one.lower(), 4, digits),
                        number(one.upper(), 4, digits), count(one.samples(), digits),
                        std::to_string(one.runs()),
                        !tested                   ? "not tested"
                        : one.misfit().rejected() ? "no"
                                                  : "yes",
                        probability(one.misfit(), digits)});
  }
  return out;
}

Section section(const v1::DynamicReport& report, Digits digits) {
  Section out;
  out.title = channel_name(report.channel()) + " over " + channel_name(report.covariate());
  bool follows = false;
  for (const v1::ParameterTrend& one : report.trends()) follows |= one.test().rejected();
  const bool misfit = report.misfit().rejected();
  const bool missed = report.links().rejected();
  out.badge = misfit    ? "a process is missing"
              : missed  ? "the curves miss the bins"
              : follows ? "noise follows it"
                        : "no change seen";
  out.mood = misfit ? Mood::kBad : missed ? Mood::kDoubtful : Mood::kGood;
  out.facts = fmt::format("{} · {:g} Hz · {} · {} · {}", report.model(), report.rate_hz(),
                          counted(report.recordings(), "recording"),
                          counted(report.bins_size(), "bin"), report.termination()) +
              estimator_fact(report.estimator());
  out.summary = report.summary();
  out.tables.push_back(trends(report, digits));
  for (const v1::DynamicQuantity& one : report.quantities()) {
    if (!one.varies()) continue;
    if (auto drawn = figure_of(report, one)) out.figures.push_back(std::move(*drawn));
    out.tables.push_back(values(report, one, digits));
  }
  out.tables.push_back(constants(report, digits));
  out.tables.push_back(bins(report, digits));
  out.notes.assign(report.notes().begin(), report.notes().end());
  return out;
}

}  // namespace

Document document(const v1::DynamicReports& reports, Digits digits) {
  Document out{"noise over a covariate", {}};
  for (const v1::DynamicReport& one : reports.channels()) {
    out.sections.push_back(section(one, digits));
  }
  if (reports.channels_size() > 0) add_files(reports.channels(0).preflight(), digits, out);
  return out;
}

}  // namespace imunoise::report
