#include "study/report/diagnosis_figures.h"

namespace imunoise::report {
namespace {

// A noise budget of the report as the figure of a fit.
std::string figure(const v1::DiagnosisReport& report, const v1::NoiseBudget& budget,
                   const std::string& model, const SvgOptions& options) {
  v1::FitReport fit;
  fit.set_channel(report.channel());
  fit.set_unit(report.unit());
  fit.set_rate_hz(report.rate_hz());
  fit.set_model(model);
  fit.set_confidence(0.95);
  *fit.mutable_budget() = budget;
  return budget_svg(fit, options);
}

}  // namespace

std::string before_svg(const v1::DiagnosisReport& report, const SvgOptions& options) {
  const std::string model = report.ladder_size() > 0 ? report.ladder(0).model() : report.model();
  return figure(report, report.before(), model, options);
}

std::string after_svg(const v1::DiagnosisReport& report, const SvgOptions& options) {
  const int rungs = report.ladder_size();
  const std::string model = rungs > 0 ? report.ladder(rungs - 1).model() : report.model();
  return figure(report, report.after(), model, options);
}

}  // namespace imunoise::report
