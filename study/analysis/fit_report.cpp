#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/support/distributions.h"
#include "core/wavelet/deviation.h"
#include "study/analysis/fit_series.h"
#include "study/analysis/noise_budget.h"
#include "study/analysis/vocabulary.h"
#include "study/words/number.h"
#include "study/words/verdict.h"

namespace imunoise::study {
namespace {

v1::Observability observability(Observability from) {
  switch (from) {
    case Observability::kObserved:
      return v1::observed;
    case Observability::kUpperBound:
      return v1::upper_bound_only;
    case Observability::kIndistinguishable:
      return v1::indistinguishable;
    case Observability::kGiven:
      break;
  }
  return v1::given;
}

v1::FitVerdict verdict_message(const TestOutcome& from) {
  if (from.degrees_of_freedom <= 0) return v1::not_tested;
  switch (report::verdict_at(from.p_value)) {
    case report::Verdict::kFits:
      return v1::fits;
    case report::Verdict::kDoubtful:
      return v1::doubtful;
    case report::Verdict::kFails:
      return v1::does_not_fit;
    case report::Verdict::kUntested:
      break;
  }
  return v1::not_tested;
}

v1::Coefficient coefficient_of(const DerivedEstimate& from, Quantity measures,
                               const std::string& label) {
  v1::Coefficient out = coefficient_message(from.coefficient, from.value, label, measures);
  out.set_lower(from.lower);
  out.set_upper(from.upper);
  if (out.datasheet_unit().empty()) return out;
  const double to_datasheet = coefficient_units(from.coefficient, measures).to_datasheet;
  out.set_datasheet_lower(from.lower * to_datasheet);
  out.set_datasheet_upper(from.upper * to_datasheet);
  return out;
}

void add_terms(const Fit& fit, const std::vector<WaveletVariance>& measured,
               const Eigen::ArrayXd& m, v1::FitReport& out) {
  const Model& model = fit.estimate.model;
  const Quantity quantity = measured.front().quantity;
  for (std::size_t t = 0; t < model.terms.size(); ++t) {
    v1::Term& term = *out.add_terms();
    term = term_message(model, t, quantity, measured.front().rate, m);
    for (int p = 0; p < term.parameters_size(); ++p) {
      const auto at = static_cast<std::size_t>(p);
      const ParameterEstimate& estimate = fit.parameters[t][at];
      v1::Parameter& parameter = *term.mutable_parameters(p);
      parameter.set_value(estimate.value);
      parameter.set_lower(estimate.lower);
      parameter.set_upper(estimate.upper);
      parameter.set_observability(observability(estimate.observability));
      if (estimate.observability == Observability::kUpperBound) {
        parameter.set_record_longer(record_longer(fit, measured, t, at));
      }
    }
    term.clear_coefficients();
    for (const DerivedEstimate& derived : fit.derived[t]) {
      *term.add_coefficients() = coefficient_of(derived, quantity, label_of(model, t));
    }
  }
}

void add_replicates(const Fit& fit, const Series& series,
                    const std::vector<WaveletVariance>& measured, v1::FitReport& out) {
  for (std::size_t k = 0; k < measured.size(); ++k) {
    v1::ReplicateResidual& one = *out.add_replicates();
    one.set_name(series.names[k]);
    one.set_samples(static_cast<std::uint32_t>(measured[k].samples));
    for (std::size_t i = 0; i < measured[k].scales.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      one.add_scales_s(2.0 * static_cast<double>(measured[k].scales[i]) / measured[k].rate.value);
      one.add_measured(measured[k].variance(at));
      const double residual = fit.residuals[k](at);
      one.add_residual(std::isfinite(residual) ? residual : 0.0);
    }
  }
}

void add_flicker(const v1::FitReport& report, v1::BiasInstability& to) {
  to.set_kind("flicker");
  for (const v1::Term& term : report.terms()) {
    for (const v1::Coefficient& one : term.coefficients())
      if (one.symbol() == "B") *to.mutable_value() = one;
  }
}

void add_minimum(const v1::NoiseBudget& budget, Quantity measures, v1::BiasInstability& to) {
  to.set_kind("minimum");
  std::vector<int> places;
  std::vector<double> curve;
  for (int i = 0; i < std::min(budget.measured_size(), budget.scales_s_size()); ++i) {
    if (!(budget.measured(i) > 0.0)) continue;
    places.push_back(i);
    curve.push_back(std::sqrt(budget.measured(i)));
  }
  if (curve.empty()) return;
  const int lowest = places[lowest_deviation(curve)];
  // The Allan variance is twice the wavelet variance, at half its averaging time.
  const double deviation = std::sqrt(2.0 * budget.measured(lowest));
  *to.mutable_value() =
      coefficient_message(Coefficient::kBiasInstability, deviation / kFlickerFloor, "", measures);
  v1::Coefficient& time = *to.mutable_time();
  time.set_symbol("τ");
  time.set_title("averaging time of the minimum");
  time.set_value(0.5 * budget.scales_s(lowest));
  time.set_unit("s");
  to.set_at_edge(lowest == places.back());
}

void add_markov(const v1::FitReport& report, v1::BiasInstability& to) {
  to.set_kind("markov");
  for (const v1::Term& term : report.terms()) {
    const v1::Coefficient* sigma = nullptr;
    const v1::Coefficient* time = nullptr;
    for (const v1::Coefficient& one : term.coefficients()) {
      if (one.symbol() == "σ") sigma = &one;
      if (one.symbol() == "T") time = &one;
    }
    if (sigma == nullptr || time == nullptr || !(time->value() > to.time().value())) continue;
    *to.mutable_value() = *sigma;
    *to.mutable_time() = *time;
  }
}

// The three quantities that are called bias instability; IEEE Std 952 defines the second.
void add_bias_instabilities(Quantity measures, v1::FitReport& report) {
  if (report.terms().empty()) return;
  add_flicker(report, *report.add_bias_instability());
  add_minimum(report.budget(), measures, *report.add_bias_instability());
  add_markov(report, *report.add_bias_instability());
}

std::string value_and_unit(const v1::Coefficient& c) {
  const bool datasheet = !c.datasheet_unit().empty();
  return report::brief(datasheet ? c.datasheet_value() : c.value()) + " " +
         (datasheet ? c.datasheet_unit() : c.unit());
}

// "gyro_x: angle random walk 2.03 °/√h, AR1 (1) 43.2 °/h over 91.7 s; the model does not fit (p <
// 0.0001)."
std::string summary_of(const v1::FitReport& report) {
  std::string known;
  for (const v1::Term& term : report.terms()) {
    const bool prepared =
        !term.parameters().empty() && term.parameters(0).observability() == v1::observed;
    if (!prepared) continue;
    bool first = true;
    for (const v1::Coefficient& c : term.coefficients()) {
      const std::string name =
          c.symbol() == "σ" ? c.title().substr(c.title().rfind("of ") + 3) : c.title();
      const bool continues = !first && c.symbol() == "T";
      known += continues
                   ? " over " + value_and_unit(c)
                   : fmt::format("{}{} {}", known.empty() ? "" : ", ", name, value_and_unit(c));
      first = false;
    }
  }
  std::string fits = "there are too few scales to test the fit";
  if (report.verdict() != v1::not_tested) {
    fits = (report.verdict() == v1::fits       ? "the model fits the measurements ("
            : report.verdict() == v1::doubtful ? "it is doubtful that the model fits ("
                                               : "the model does not fit the measurements (") +
           chance_words(report.p_value()) + ")";
  }
  return fmt::format("{}: {}{}.", report.channel(), known.empty() ? "" : known + "; ", fits);
}

}  // namespace

v1::FitReport fit_report(const Fit& fit, const Series& series,
                         const std::vector<WaveletVariance>& measured) {
  const WaveletVariance total = pooled(measured);
  v1::FitReport out;
  out.set_channel(series.channel);
  out.set_unit(std::string(si_symbol(total.quantity)));
  out.set_quantity(std::string(quantity_name(total.quantity)));
  out.set_rate_hz(total.rate.value);
  out.set_weights(fit.estimate.weighting == Weighting::kFull ? "full" : "diag");
  out.set_objective(fit.estimate.objective);
  out.set_j_statistic(fit.goodness.statistic);
  out.set_degrees_of_freedom(fit.goodness.degrees_of_freedom);
  out.set_p_value(fit.goodness.p_value);
  out.set_verdict(verdict_message(fit.goodness));
  out.set_termination(std::string(describe(fit.estimate.termination)));
  out.set_confidence(fit.confidence);
  add_terms(fit, measured, total.scales.half_widths(), out);
  *out.mutable_budget() =
      noise_budget(fit.estimate.model, measured, fit.covariances, fit.tested, fit.confidence);
  add_replicates(fit, series, measured, out);
  add_bias_instabilities(total.quantity, out);
  out.set_summary(summary_of(out));
  if (total.quantity == Quantity::kUnknown) {
    out.add_notes(
        "The recording states no unit: numbers are in its own. Name it with --unit, e.g. --unit "
        "deg/s.");
  }
  return out;
}

}  // namespace imunoise::study
