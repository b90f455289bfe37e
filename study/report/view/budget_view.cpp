#include "study/report/view/budget_view.h"

#include <algorithm>
#include <cmath>

#include "core/support/units.h"

namespace imunoise::report {
namespace {

using Doubles = google::protobuf::RepeatedField<double>;

double at(const Doubles& values, int i) { return i < values.size() ? values[i] : kMissing; }

// Scales whose time is no time cannot be placed on any axis.
bool is_time(double seconds) { return std::isfinite(seconds) && seconds > 0.0; }

void sort_by_time(std::vector<ScaleView>& scales) {
  std::stable_sort(scales.begin(), scales.end(),
                   [](const ScaleView& a, const ScaleView& b) { return a.seconds < b.seconds; });
}

using Terms = google::protobuf::RepeatedPtrField<v1::Term>;

std::vector<std::string> term_names(const Terms& terms) {
  std::vector<std::string> out;
  for (int i = 0; i < terms.size(); ++i) {
    const std::string& name = terms[i].name();
    int same = 0;
    int before = 0;
    for (int k = 0; k < terms.size(); ++k) {
      if (terms[k].name() != name) continue;
      ++same;
      if (k < i) ++before;
    }
    out.push_back(same > 1 ? name + " (" + std::to_string(before + 1) + ")" : name);
  }
  return out;
}

void add_terms(const Terms& terms, BudgetView& to) {
  to.terms = term_names(terms);
  for (ScaleView& scale : to.scales) {
    for (const v1::Term& term : terms)
      scale.terms.push_back(at(term.variance(), static_cast<int>(scale.index)));
  }
}

}  // namespace

bool ScaleView::outside() const { return tested && std::abs(residual) > kSigmaLimit; }

double ScaleView::share(std::size_t term) const {
  return model > 0.0 ? terms[term] / model : kMissing;
}

BudgetView budget_view(const v1::FitReport& report) {
  BudgetView out = budget_view(report.budget());
  add_terms(report.terms(), out);
  out.replicates = replicate_views(report.replicates());
  return out;
}

BudgetView budget_view(const v1::RungPicture& picture) {
  BudgetView out = budget_view(picture.budget());
  add_terms(picture.terms(), out);
  out.replicates = replicate_views(picture.compared().replicates());
  return out;
}

BudgetView budget_view(const v1::NoiseBudget& budget) {
  BudgetView out;
  for (int i = 0; i < budget.scales_s_size(); ++i) {
    if (!is_time(budget.scales_s(i))) continue;
    ScaleView scale;
    scale.index = static_cast<std::size_t>(i);
    scale.seconds = budget.scales_s(i);
    scale.measured = at(budget.measured(), i);
    scale.lower = at(budget.lower(), i);
    scale.upper = at(budget.upper(), i);
    scale.model = at(budget.model(), i);
    scale.residual = at(budget.residual(), i);
    scale.tested = i < budget.tested_size() && budget.tested(i);
    out.scales.push_back(std::move(scale));
  }
  sort_by_time(out.scales);
  return out;
}

BudgetView budget_view(const v1::WaveletVarianceReport& report) {
  BudgetView out;
  for (int i = 0; i < std::min(report.scales_s_size(), report.variance_size()); ++i) {
    ScaleView scale;
    scale.index = static_cast<std::size_t>(i);
    scale.seconds = report.scales_s(i);
    scale.measured = report.variance(i);
    scale.lower = at(report.lower(), i);
    scale.upper = at(report.upper(), i);
    out.scales.push_back(std::move(scale));
  }
  return out;
}

std::vector<ReplicateView> replicate_views(
    const google::protobuf::RepeatedPtrField<v1::ReplicateResidual>& replicates) {
  std::vector<ReplicateView> out;
  for (const v1::ReplicateResidual& from : replicates) {
    ReplicateView replicate;
    replicate.name = from.name();
    replicate.samples = from.samples();
    for (int i = 0; i < from.scales_s_size(); ++i) {
      if (!is_time(from.scales_s(i))) continue;
      ScaleView scale;
      scale.index = static_cast<std::size_t>(i);
      scale.seconds = from.scales_s(i);
      scale.measured = at(from.measured(), i);
      scale.residual = at(from.residual(), i);
      replicate.scales.push_back(std::move(scale));
    }
    sort_by_time(replicate.scales);
    out.push_back(std::move(replicate));
  }
  return out;
}

double AllanUnit::deviation(double variance) const { return std::sqrt(2.0 * variance) * factor; }

double AllanUnit::variance(double deviation) const {
  const double in_si = deviation / factor;
  return 0.5 * in_si * in_si;
}

AllanUnit allan_unit(const std::string& unit, bool si) {
  if (const auto parsed = parse_unit(unit); parsed && !si) {
    const CoefficientUnits units =
        coefficient_units(Coefficient::kBiasInstability, parsed->quantity);
    if (!units.datasheet.empty()) return {units.to_datasheet * parsed->to_si, units.datasheet};
  }
  return {1.0, unit.empty() || unit == "1" ? "unit" : unit};
}

BudgetView as_allan(BudgetView view, const AllanUnit& unit) {
  const auto change = [&](ScaleView& scale) {
    scale.seconds *= 0.5;
    for (double* const one :
         {&scale.measured, &scale.lower, &scale.upper, &scale.model, &scale.ghost})
      *one = unit.deviation(*one);
    for (double& one : scale.terms) one = unit.deviation(one);
  };
  for (ScaleView& scale : view.scales) change(scale);
  for (ReplicateView& replicate : view.replicates) {
    for (ScaleView& scale : replicate.scales) change(scale);
  }
  return view;
}

std::string squared(const std::string& unit) {
  if (unit.empty() || unit == "1") return "unit²";
  return unit.find_first_of("/ *^") == std::string::npos ? unit + "²" : "(" + unit + ")²";
}

}  // namespace imunoise::report
