#include "study/report/html/fit_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "study/figure/figure.h"
#include "study/report/documents/effect_rows.h"
#include "study/report/html/page_frame.h"
#include "study/report/view/bias_instability.h"
#include "study/report/view/verdict.h"
#include "study/words/number.h"
#include "study/words/text.h"

namespace imunoise::report {
namespace {

constexpr Digits kStyle = Digits::kTypeset;

std::string unit_text(const std::string& unit) { return unit == "1" ? "" : unit; }

std::string interval_title(const v1::FitReport& report) {
  return report.confidence() > 0.0 ? percent(report.confidence()) + " interval" : "interval";
}

std::string parameter_cells(const v1::Term& term, const v1::Parameter& p) {
  const bool bound = only_bounded(p) && p.upper() > 0.0;
  const char* const mood =
      p.observability() == v1::upper_bound_only || p.observability() == v1::indistinguishable
          ? "open"
          : "quiet";
  std::string out =
      markup_cell("", fmt::format(R"({}<span class="explain">{}</span>)", escape_markup(p.name()),
                                  escape_markup(p.meaning())));
  out += cell("number", rounded(p.value(), p.lower(), p.upper(), kStyle));
  out += cell("number", bound ? "below " + number(p.upper(), 2, kStyle)
                              : interval(p.value(), p.lower(), p.upper(), kStyle));
  out += cell("", unit_text(p.unit()));
  return out + cell(mood, observability_words(term, p));
}

}  // namespace

std::string parameter_table(const v1::FitReport& report) {
  const std::vector<std::string> names = budget_view(report).terms;
  std::string rows;
  for (std::size_t t = 0; t < names.size(); ++t) {
    const v1::Term& term = report.terms(static_cast<int>(t));
    const std::string title = fmt::format(
        R"(<td class="term" rowspan="{}"><span class="swatch )"
        "term-{}\"></span><strong>{}</strong> {}"
        R"(<span class="explain">{}</span></td>)",
        std::max(1, term.parameters_size()), t % figure::kTermStyles, escape_markup(names[t]),
        escape_markup(term.title()), escape_markup(term.meaning()));
    if (term.parameters().empty()) rows += "<tr>" + title + "<td colspan=\"5\"></td></tr>\n";
    for (int p = 0; p < term.parameters_size(); ++p) {
      rows +=
          "<tr>" + (p == 0 ? title : "") + parameter_cells(term, term.parameters(p)) + "</tr>\n";
    }
  }
  if (rows.empty()) return {};
  return "<h3>Parameters, per sample</h3>\n<div class=\"scroll\"><table>" +
         table_head({"term", "parameter", "value", interval_title(report), "unit",
                     "identified by the data?"}) +
         "<tbody>" + rows + "</tbody></table></div>\n";
}

std::string coefficient_table(const v1::FitReport& report) {
  std::string rows;
  for (const v1::Term& term : report.terms()) {
    for (const v1::Coefficient& c : term.coefficients()) {
      rows += "<tr>" + markup_cell("", "<strong>" + escape_markup(c.symbol()) + "</strong>") +
              cell("", c.title());
      const std::string sheet =
          with_interval(c.datasheet_value(), c.datasheet_lower(), c.datasheet_upper(), kStyle);
      rows += c.datasheet_unit().empty() ? cell("quiet", "none is customary")
                                         : cell("number", sheet + " " + c.datasheet_unit());
      rows += cell("number", with_interval(c.value(), c.lower(), c.upper(), kStyle) + " " +
                                 unit_text(c.unit()));
      rows += "</tr>\n";
    }
  }
  if (rows.empty()) return {};
  return "<h3>Coefficients, as in data sheets</h3>\n<div class=\"scroll\"><table>" +
         table_head({"symbol", "name", "data-sheet unit", "SI"}) + "<tbody>" + rows +
         "</tbody></table></div>\n";
}

std::string bias_instability_table(const v1::FitReport& report) {
  std::string rows;
  for (const BiasInstability& one : bias_instabilities(report, kStyle))
    rows += "<tr>" + cell("", one.meaning) + cell("number", one.value) + cell("", one.remark) +
            "</tr>\n";
  if (rows.empty()) return {};
  return "<h3>Bias instability</h3>\n<div class=\"scroll\"><table>" +
         table_head({"meaning", "value", ""}) + "<tbody>" + rows + "</tbody></table></div>\n";
}

std::string fitted_effect_table(const v1::FitReport& report) {
  std::string rows;
  for (const std::vector<std::string>& row : effect_rows(report.effects(), kStyle))
    rows += "<tr>" + cell("term", row[0]) + cell("", row[1]) + cell("number", row[2]) + "</tr>\n";
  if (rows.empty()) return {};
  return "<h3>Effects, taken out before the noise was fitted</h3>\n<div class=\"scroll\"><table>" +
         table_head({"effect", "", "value"}) + "<tbody>" + rows + "</tbody></table></div>\n";
}

std::string scale_table(const v1::FitReport& report, const BudgetView& view) {
  if (view.scales.empty()) return {};
  std::vector<std::string> titles = {"averaging time", "measured, " + squared(report.unit()),
                                     "model, " + squared(report.unit()), "residual"};
  for (const std::string& term : view.terms) titles.push_back(term + " share");
  std::string rows;
  for (const ScaleView& scale : view.scales) {
    rows +=
        "<tr>" + cell("number", duration(scale.seconds)) +
        cell("number", with_interval(scale.measured, scale.lower, scale.upper, kStyle)) +
        cell("number", number(scale.model, 4, kStyle)) +
        cell(scale.outside() ? "number outside" : "number",
             signed_sigma(scale.residual, kStyle) + " σ" + (scale.tested ? "" : " (not tested)"));
    for (std::size_t t = 0; t < view.terms.size(); ++t) {
      rows += cell("number", percent(scale.share(t)));
    }
    rows += "</tr>\n";
  }
  return "<details><summary>The numbers at every scale</summary>\n<div class=\"scroll\">"
         R"(<table class="scales">)" +
         table_head(titles) + "<tbody>" + rows + "</tbody></table></div></details>\n";
}

std::string provenance(const v1::FitReport& report) {
  std::string out = R"(<dl class="provenance">)";
  const auto fact = [&out](const char* name, const std::string& value) {
    if (!value.empty()) {
      out += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", name, escape_markup(value));
    }
  };
  fact("model", report.model() + (report.default_model() ? " (default)" : ""));
  fact("estimator", report.estimator());
  fact("weights", report.weights());
  fact("objective", number(report.objective(), 4, kStyle));
  if (verdict(report) != Verdict::kUntested) {
    fact("J statistic",
         fmt::format("{} with {} degrees of freedom", number(report.j_statistic(), 4, kStyle),
                     report.degrees_of_freedom()));
    fact("p-value", number(report.p_value(), 2, kStyle));
  }
  fact("search ended", report.termination());
  return out + "</dl>\n";
}

}  // namespace imunoise::report
