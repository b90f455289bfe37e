#include "core/dynamic/free_numbers.h"

#include <cmath>

#include "core/process/parameter_scale.h"

namespace imunoise {
namespace {

using Kind = FreeNumber::Kind;

bool follows_a_scale(const Trend& trend) {
  return trend.link == Link::kExponential || trend.link == Link::kLogistic;
}

bool slope_is_inside(const Trend& trend) {
  return follows_a_scale(trend) && std::abs(trend.slope) < kSteepestTrend * (1.0 - 1e-6);
}

// What of a power counts at a covariate.
double share(Kind kind, const Trend& trend, double covariate) {
  switch (kind) {
    case Kind::kFirst:
      return 0.5 * (1.0 - covariate);
    case Kind::kLast:
      return 0.5 * (1.0 + covariate);
    default:
      return trend.link == Link::kExponential ? std::exp(trend.slope * covariate) : 1.0;
  }
}

void add_power(const Model& model, std::size_t t, std::vector<FreeNumber>& to) {
  const Trend& trend = model.terms[t].trends[0];
  const double value = values(model.terms[t].process)[0];
  if (trend.link == Link::kLinear) {
    for (const Kind end : {Kind::kFirst, Kind::kLast}) {
      const FreeNumber number{t, 0, end, false};
      to.push_back({t, 0, end, !(power_of(model, number) > 0.0)});
    }
  } else if (trend.link == Link::kConstant || !(value > 0.0)) {
    to.push_back({t, 0, Kind::kPower, !(value > 0.0)});
  } else {
    to.push_back({t, 0, Kind::kLevel, false});
    if (slope_is_inside(trend)) to.push_back({t, 0, Kind::kSlope, false});
  }
}

}  // namespace

std::vector<FreeNumber> free_numbers(const Model& model) {
  std::vector<FreeNumber> out;
  for (std::size_t t = 0; t < model.terms.size(); ++t) {
    const Term& term = model.terms[t];
    const std::vector<ParameterInfo> about = parameters(term.process);
    const std::vector<double> v = values(term.process);
    if (!term.given[0]) add_power(model, t, out);
    for (std::size_t p = 1; p < v.size(); ++p) {
      if (term.given[p] || !(v[0] > 0.0)) continue;
      if (!at_bound(about[p], v[p])) out.push_back({t, p, Kind::kLevel, false});
      if (slope_is_inside(term.trends[p])) out.push_back({t, p, Kind::kSlope, false});
    }
  }
  return out;
}

Eigen::MatrixXd jacobian(const Model& model, const std::vector<FreeNumber>& numbers,
                         double covariate, HalfWidths m) {
  Eigen::MatrixXd out(m.size(), static_cast<Eigen::Index>(numbers.size()));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const FreeNumber& number = numbers[i];
    const Term& term = model.terms[number.term];
    auto column = out.col(static_cast<Eigen::Index>(i));
    if (number.kind == Kind::kLevel || number.kind == Kind::kSlope) {
      const double along = number.kind == Kind::kSlope ? covariate : 1.0;
      column = along * change_with(term, number.parameter, covariate, m).matrix();
    } else {
      column = share(number.kind, term.trends[0], covariate) *
               shape(process_at(term, covariate), m).matrix();
    }
  }
  return out;
}

double speed(const Model& model, const FreeNumber& number, double covariate) {
  const Term& term = model.terms[number.term];
  if (number.kind != Kind::kLevel && number.kind != Kind::kSlope) {
    return share(number.kind, term.trends[0], covariate);
  }
  const double value = values(process_at(term, covariate))[number.parameter];
  const ParameterScale scale(parameters(term.process)[number.parameter], number.parameter);
  return (number.kind == Kind::kSlope ? covariate : 1.0) * scale.slope(value);
}

double power_of(const Model& model, const FreeNumber& number) {
  const Term& term = model.terms[number.term];
  const double middle = values(term.process)[0];
  if (number.kind == Kind::kFirst) return middle - term.trends[0].slope;
  if (number.kind == Kind::kLast) return middle + term.trends[0].slope;
  return middle;
}

Model with_power(Model model, const FreeNumber& number, double value) {
  Term& term = model.terms[number.term];
  std::vector<double> v = values(term.process);
  if (number.kind == Kind::kPower) {
    v[0] = value;
  } else {
    const double half = 0.5 * (value - power_of(model, number));
    v[0] += half;
    term.trends[0].slope += number.kind == Kind::kLast ? half : -half;
  }
  set_values(term.process, v);
  return model;
}

}  // namespace imunoise
