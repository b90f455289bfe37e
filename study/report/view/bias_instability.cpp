#include "study/report/view/bias_instability.h"

#include <fmt/format.h>

#include "study/report/view/budget_view.h"

namespace imunoise::report {
namespace {

// σ_Allan of the floor of flicker noise over B: √(2 ln2/π).
constexpr double kFlickerFloor = 0.664;

std::string value_of(const v1::Coefficient& c, Digits digits) {
  if (c.datasheet_unit().empty())
    return with_interval(c.value(), c.lower(), c.upper(), digits) + " " + c.unit();
  return with_interval(c.datasheet_value(), c.datasheet_lower(), c.datasheet_upper(), digits) +
         " " + c.datasheet_unit();
}

BiasInstability flicker(const v1::FitReport& report, Digits digits) {
  BiasInstability out{"coefficient of flicker noise", "none", "the model has no FN"};
  for (const v1::Term& term : report.terms()) {
    for (const v1::Coefficient& one : term.coefficients())
      if (one.symbol() == "B") out = {out.meaning, value_of(one, digits), "of the model"};
  }
  return out;
}

BiasInstability minimum(const v1::FitReport& report, Digits digits) {
  BiasInstability out{"minimum of the Allan deviation / 0.664", "none", "nothing was measured"};
  const AllanUnit unit = allan_unit(report.unit());
  const std::vector<ScaleView> scales = budget_view(report).scales;
  const ScaleView* lowest = nullptr;
  for (const ScaleView& one : scales)
    if (one.measured > 0.0 && (lowest == nullptr || one.measured < lowest->measured)) lowest = &one;
  if (lowest == nullptr) return out;
  out.value = number(unit.deviation(lowest->measured) / kFlickerFloor, 3, digits) + " " + unit.unit;
  out.remark = "measured at " + duration(0.5 * lowest->seconds);
  if (lowest == &scales.back()) out.remark += ", at the edge: record longer";
  return out;
}

BiasInstability markov(const v1::FitReport& report, Digits digits) {
  BiasInstability out{"standard deviation of the slowest Markov process", "none",
                      "the model has no AR1 or GM"};
  double slowest = 0.0;
  for (const v1::Term& term : report.terms()) {
    const v1::Coefficient* sigma = nullptr;
    const v1::Coefficient* time = nullptr;
    for (const v1::Coefficient& one : term.coefficients()) {
      if (one.symbol() == "σ") sigma = &one;
      if (one.symbol() == "T") time = &one;
    }
    if (sigma == nullptr || time == nullptr || !(time->value() > slowest)) continue;
    slowest = time->value();
    out.value = value_of(*sigma, digits);
    out.remark = "correlation time " + value_of(*time, digits);
  }
  return out;
}

}  // namespace

std::vector<BiasInstability> bias_instabilities(const v1::FitReport& report, Digits digits) {
  return {flicker(report, digits), minimum(report, digits), markov(report, digits)};
}

}  // namespace imunoise::report
