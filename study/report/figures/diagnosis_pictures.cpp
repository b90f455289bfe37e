#include "study/report/figures/diagnosis_pictures.h"

#include <fmt/format.h>

#include "study/report/figures/budget_figure.h"
#include "study/report/figures/comparison_figures.h"
#include "study/report/figures/error_panel.h"
#include "study/report/view/verdict.h"

namespace imunoise::report {
namespace {

// The budget of a rung, whose misfit is one test of all that it leaves.
figure::Figure rung_figure(const v1::DiagnosisReport& report, const v1::NoiseBudget& budget,
                           int rung) {
  const bool known = rung >= 0 && rung < report.ladder_size();
  const Verdict found = known ? verdict_at(report.ladder(rung).misfit_p()) : Verdict::kUntested;
  return budget_figure(budget_view(budget),
                       {.channel = report.channel(),
                        .unit = report.unit(),
                        .subtitle = fmt::format(
                            "{}: {} · {:g} Hz", verdict_words(found),
                            known ? report.ladder(rung).model() : report.model(), report.rate_hz()),
                        .confidence = 0.95,
                        .mark_misfits = fails(found)});
}

}  // namespace

figure::Figure before_figure(const v1::DiagnosisReport& report) {
  return rung_figure(report, report.before(), 0);
}

figure::Figure after_figure(const v1::DiagnosisReport& report) {
  return rung_figure(report, report.after(), report.ladder_size() - 1);
}

std::vector<Picture> pictures(const v1::DiagnosisReport& report) {
  std::vector<Picture> out{{"before", before_figure(report)}, {"after", after_figure(report)}};
  const auto add_spectrum = [&](const char* word, const v1::Comparison& compared,
                                const std::string& model) {
    auto spectrum = spectrum_figure(report, compared,
                                    fmt::format("{}: spectrum under {}", report.channel(), model));
    if (spectrum) out.push_back({word, std::move(*spectrum)});
  };
  if (report.has_compared_before())
    add_spectrum("spectrum_before", report.compared_before(), report.model());
  if (report.has_compared_after() && report.ladder_size() > 0)
    add_spectrum("spectrum_after", report.compared_after(),
                 report.ladder(report.ladder_size() - 1).model());
  if (auto panel = error_panel(report)) out.push_back({"errors", std::move(*panel)});
  return out;
}

}  // namespace imunoise::report
