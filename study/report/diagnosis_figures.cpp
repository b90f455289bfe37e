#include "study/report/diagnosis_figures.h"

#include <fmt/format.h>

#include "study/report/comparison_figures.h"

namespace imunoise::report {
namespace {

// A noise budget of the report as the figure of a fit. A rung's misfit is one test of all that it
// leaves.
std::string figure(const v1::DiagnosisReport& report, const v1::NoiseBudget& budget, int rung,
                   const SvgOptions& options) {
  v1::FitReport fit;
  fit.set_channel(report.channel());
  fit.set_unit(report.unit());
  fit.set_rate_hz(report.rate_hz());
  fit.set_model(report.model());
  fit.set_confidence(0.95);
  if (rung >= 0 && rung < report.ladder_size()) {
    fit.set_model(report.ladder(rung).model());
    fit.set_p_value(report.ladder(rung).misfit_p());
    fit.set_degrees_of_freedom(1);
  }
  *fit.mutable_budget() = budget;
  return budget_svg(fit, options);
}

}  // namespace

std::string before_svg(const v1::DiagnosisReport& report, const SvgOptions& options) {
  return figure(report, report.before(), 0, options);
}

std::string after_svg(const v1::DiagnosisReport& report, const SvgOptions& options) {
  return figure(report, report.after(), report.ladder_size() - 1, options);
}

std::vector<Picture> pictures(const v1::DiagnosisReport& report) {
  const auto spectrum = [&](const v1::Comparison& compared, const std::string& model) {
    return curve_svg(spectrum_chart(report, compared,
                                    fmt::format("{}: spectrum under {}", report.channel(), model)));
  };
  std::vector<Picture> out{{"before", before_svg(report)}, {"after", after_svg(report)}};
  if (report.has_compared_before())
    out.push_back({"spectrum_before", spectrum(report.compared_before(), report.model())});
  if (report.has_compared_after())
    out.push_back({"spectrum_after", spectrum(report.compared_after(),
                                              report.ladder(report.ladder_size() - 1).model())});
  return out;
}

}  // namespace imunoise::report
