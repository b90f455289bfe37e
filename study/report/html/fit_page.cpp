#include "study/report/html/fit_page.h"

#include <fmt/format.h>

#include "study/report/documents/preflight_section.h"
#include "study/report/figures/budget_figure.h"
#include "study/report/html/document_page.h"
#include "study/report/html/fit_tables.h"
#include "study/report/html/page_frame.h"
#include "study/report/view/verdict.h"
#include "study/words/text.h"

namespace imunoise::report {
namespace {

std::string css_class(Verdict verdict) {
  switch (verdict) {
    case Verdict::kFits:
      return "fits";
    case Verdict::kDoubtful:
      return "doubtful";
    case Verdict::kFails:
      return "fails";
    case Verdict::kUntested:
      break;
  }
  return "untested";
}

// A sign beside the colour: colours alone do not reach everybody.
const char* sign(Verdict verdict) {
  switch (verdict) {
    case Verdict::kFits:
      return "✓";
    case Verdict::kDoubtful:
      return "?";
    case Verdict::kFails:
      return "✗";
    case Verdict::kUntested:
      break;
  }
  return "–";
}

std::string heading(const v1::FitReport& report) {
  const Verdict v = verdict(report);
  std::string out = fmt::format(
      "<div class=\"heading\"><h2>{}</h2><span class=\"badge {}\">{} {}</span></div>\n"
      "<p class=\"facts\">{}</p>\n",
      escape_markup(channel_name(report.channel())), css_class(v), sign(v), verdict_words(v),
      escape_markup(facts(report)));
  if (!report.summary().empty()) {
    out += fmt::format("<p class=\"summary\">{}</p>\n", escape_markup(report.summary()));
  }
  return out + fmt::format("<p class=\"meaning\">{}</p>\n", verdict_sentence(report));
}

std::string misfit_list(const v1::FitReport& report, const BudgetView& view) {
  const Verdict v = verdict(report);
  if (v != Verdict::kFails && v != Verdict::kDoubtful) return {};
  std::string out;
  for (const Misfit& misfit : misfits(view)) {
    out += "<li>" + escape_markup(misfit_words(view, misfit)) + "</li>\n";
  }
  return out.empty()
             ? out
             : "<ul class=\"misfits\" aria-label=\"where the model fails\">\n" + out + "</ul>\n";
}

std::string legend(const v1::FitReport& report, const BudgetView& view) {
  if (view.terms.empty()) return {};
  std::string out = R"(<div class="legend" role="group" aria-label="show or hide terms">)";
  for (std::size_t t = 0; t < view.terms.size(); ++t) {
    out += fmt::format(
        R"(<button type="button" aria-pressed="true" data-term="{}"><span class="swatch )"
        "term-{}\">"
        "</span>{} {}</button>",
        escape_markup(view.terms[t]), t % figure::kTermStyles, escape_markup(view.terms[t]),
        escape_markup(report.terms(static_cast<int>(t)).title()));
  }
  return out + "</div>\n";
}

std::string budget(const v1::FitReport& report, const BudgetView& view) {
  const figure::Figure drawn = budget_figure(report);
  return "<figure class=\"budget\">\n" + legend(report, view) +
         R"(<div class="plot" tabindex="0" role="group" )"
         "aria-label=\"noise budget; arrow keys read the scales one by one\">\n" +
         two_widths(drawn) +
         "</div>\n<div class=\"readout\" role=\"status\"><span class=\"hint\">Point at the figure, "
         "or "
         "use the arrow keys, to read a scale.</span></div>\n<figcaption>" +
         escape_markup(drawn.caption) + "</figcaption>\n</figure>\n";
}

std::string replicates(const v1::FitReport& report, const BudgetView& view) {
  const auto drawn = replicates_figure(view.replicates, report.channel());
  if (view.replicates.size() < 2 || !drawn) return {};
  return "<h3>Replicates</h3>\n<figure class=\"replicates\">\n" + two_widths(*drawn) +
         "<figcaption>" + escape_markup(drawn->caption) + "</figcaption>\n</figure>\n";
}

std::string notes(const v1::FitReport& report) {
  if (report.notes().empty()) return {};
  std::string out = "<h3>Notes</h3>\n<ul class=\"notes\">\n";
  for (const std::string& note : report.notes()) out += "<li>" + escape_markup(note) + "</li>\n";
  return out + "</ul>\n";
}

std::string fitted_model(const v1::FitReport& report) {
  if (report.fitted_model().empty()) return {};
  return R"(<div class="model-box"><pre tabindex="0" aria-label="fitted model">)" +
         escape_markup(report.fitted_model()) +
         "</pre><button type=\"button\" class=\"copy\">copy</button></div>\n";
}

std::string section(const v1::FitReport& report, int index) {
  const std::string id = fmt::format("channel-{}", index);
  const BudgetView view = budget_view(report);
  return fmt::format("<section id=\"{}\" aria-label=\"{}\">\n", id,
                     escape_markup(channel_name(report.channel()))) +
         heading(report) + misfit_list(report, view) + budget(report, view) +
         scale_table(report, view) + coefficient_table(report) + bias_instability_table(report) +
         parameter_table(report) + fitted_effect_table(report) + replicates(report, view) +
         notes(report) + "<h3>How it was fitted</h3>\n" + fitted_model(report) +
         provenance(report) + "</section>\n";
}

std::string navigation(const v1::FitReports& reports) {
  if (reports.channels_size() < 2) return {};
  std::string out = R"(<nav aria-label="channels">)";
  for (int i = 0; i < reports.channels_size(); ++i) {
    const Verdict v = verdict(reports.channels(i));
    out += fmt::format(R"(<a href="#channel-{}"><span class="mark {}" title="{}">{}</span>{}</a>)",
                       i, css_class(v), verdict_words(v), sign(v),
                       escape_markup(channel_name(reports.channels(i).channel())));
  }
  return out + "</nav>\n";
}

}  // namespace

std::string html_page(const v1::FitReports& reports) {
  std::string title = "Noise budget";
  for (const v1::FitReport& report : reports.channels()) {
    title += (title == "Noise budget" ? " of " : ", ") + channel_name(report.channel());
  }
  std::string body = navigation(reports) + "<main>\n";
  if (reports.channels().empty()) body += "<p>This report holds no channel.</p>\n";
  for (int i = 0; i < reports.channels_size(); ++i) body += section(reports.channels(i), i);
  Document files;
  if (!reports.channels().empty())
    add_files(reports.channels(0).preflight(), Digits::kTypeset, files);
  for (std::size_t i = 0; i < files.sections.size(); ++i)
    body += section_markup(files.sections[i], i);
  return page_frame(title, "noise budget", body + "</main>\n");
}

std::string html_page(const v1::FitReport& report) {
  v1::FitReports one;
  *one.add_channels() = report;
  return html_page(one);
}

}  // namespace imunoise::report
