#include "core/inference/intervals.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/process/parameter_scale.h"
#include "core/support/distributions.h"
#include "core/support/roots.h"

namespace imunoise {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Seen, without further questions.
bool clear(double standard_errors) { return standard_errors > 6.0; }

Process with_value(const Process& process, std::size_t parameter, double value) {
  Process out = process;
  std::vector<double> v = values(process);
  v[parameter] = value;
  set_values(out, v);
  return out;
}

// Derived quantities of a process with one parameter moved.
std::vector<DerivedQuantity> derived_with(const Process& process, std::size_t parameter,
                                          double value, Hertz rate) {
  return derived(with_value(process, parameter, value), rate);
}

// The same coefficient among moved quantities (a process may lose one, as AR1 its time when φ < 0).
double find(const std::vector<DerivedQuantity>& all, Coefficient coefficient, double otherwise) {
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const auto& q) { return q.coefficient == coefficient; });
  return found == all.end() ? otherwise : found->value;
}

// A power is called seen only where its estimate is above z standard errors, and such estimates are
// too large in the mean. By what factor the lower end of an interval falls when that is counted:
// the smallest mean under which an estimate that passes is `ratio` or more with half the
// probability left outside (Weinstein, Fithian & Benjamini 2013, J. Am. Stat. Assoc. 108:165), over
// the one without selection. `ratio`: the estimate in standard errors, above z.
double selection_factor(double ratio, double z) {
  constexpr double kFar = 30.0;
  if (!(ratio < kFar)) return 1.0;
  const double outside = normal_tail(z);
  const auto excess = [&](double mean) {
    return normal_tail(ratio - mean) - outside * normal_tail(z - mean);
  };
  if (excess(0.0) >= 0.0) return 0.0;
  return std::min(1.0, root_between(excess, 0.0, ratio) / (ratio - z));
}

}  // namespace

PowerLimit::PowerLimit(const std::function<Eigen::ArrayXd(HalfWidths)>& variance, double samples) {
  constexpr double kErrors = 4.0;
  constexpr double kFewest = 8.0;  // degrees of freedom at the longest scale
  const auto scales =
      std::max<Eigen::Index>(1, static_cast<Eigen::Index>(std::log2(samples / (2.0 * kFewest))));
  m_.resize(scales);
  for (Eigen::Index j = 0; j < scales; ++j) m_(j) = std::exp2(static_cast<double>(j));
  limit_ = variance(m_) * (1.0 + kErrors * (4.0 * m_ / samples).sqrt());
}

double PowerLimit::most(const Process& process,
                        const std::vector<ParameterEstimate>& estimates) const {
  double out = 0.0;
  const auto look_at = [&](std::size_t parameter, double value) {
    const double most = (limit_ / shape(with_value(process, parameter, value), m_)).minCoeff();
    if (std::isfinite(most)) out = std::max(out, most);
  };
  for (std::size_t p = 1; p < estimates.size(); ++p) {
    look_at(p, estimates[p].lower);
    look_at(p, estimates[p].upper);
  }
  look_at(0, values(process)[0]);
  return out;
}

DerivedEstimate derived_interval(const Term& term, const std::vector<ParameterEstimate>& estimates,
                                 const Eigen::MatrixXd& covariance, const DerivedQuantity& quantity,
                                 Hertz rate, double z) {
  const std::vector<double> v = values(term.process);
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(v.size()));
  std::vector<std::size_t> moves;
  for (std::size_t p = 0; p < v.size(); ++p) {
    if (estimates[p].observability == Observability::kGiven) continue;
    double step = 1e-4 * std::abs(v[p]);
    if (std::isfinite(estimates[p].standard_error))
      step = std::min(step, 1e-3 * estimates[p].standard_error);
    if (p > 0)
      step = std::min(step, 1e-3 * (1.0 - std::min(std::abs(v[p]), 1.0 - 1e-12)) +
                                (std::abs(v[p]) > 1.0 ? step : 0.0));
    if (step == 0.0) {  // of no power: a time does not depend on it
      const double other =
          find(derived_with(term.process, p, 1.0, rate), quantity.coefficient, 0.0);
      if (other != quantity.value) moves.push_back(p);
      continue;
    }
    const double up = find(derived_with(term.process, p, v[p] + step, rate), quantity.coefficient,
                           quantity.value);
    const double down = find(derived_with(term.process, p, v[p] - step, rate), quantity.coefficient,
                             quantity.value);
    slope(static_cast<Eigen::Index>(p)) = (up - down) / (2.0 * step);
    if (up != down) moves.push_back(p);
  }
  DerivedEstimate out{quantity.coefficient, quantity.value, quantity.value, quantity.value};
  if (moves.empty()) return out;
  const auto seen = [&](std::size_t p) {
    return estimates[p].observability == Observability::kObserved;
  };
  if (moves.size() == 1 || !std::all_of(moves.begin(), moves.end(), seen)) {
    const auto worst = std::find_if_not(moves.begin(), moves.end(), seen);
    const std::size_t p = worst == moves.end() ? moves.front() : *worst;
    const auto end = [&](double value) {
      if (!std::isfinite(value)) return kInfinity;
      return find(derived_with(term.process, p, value, rate), quantity.coefficient, 0.0);
    };
    const double a = end(estimates[p].lower);
    const double b = end(estimates[p].upper);
    out.lower = std::min({a, b, quantity.value});  // it may be least between the ends
    out.upper = std::max({a, b, quantity.value});
    return out;
  }
  const double relative = std::sqrt(std::max(0.0, slope.dot(covariance * slope))) / quantity.value;
  out.lower = quantity.value * std::exp(-z * relative);
  out.upper = quantity.value * std::exp(z * relative);
  return out;
}

bool alone(const Term& term) {
  return std::all_of(term.given.begin() + 1, term.given.end(), [](bool one) { return one; });
}

double upper_bound(double value, double upper, double z,
                   const std::function<double(double)>& error_at) {
  constexpr int kRounds = 2;
  for (int round = 0; round < kRounds && std::isfinite(upper) && upper > 0.0; ++round) {
    upper = std::max(upper, value + z * error_at(upper));
  }
  return upper;
}

ParameterEstimate interval(const ParameterInfo& info, std::size_t index, double value,
                           double standard_error, double confidence, double evidence) {
  const double z = normal_quantile(0.5 + 0.5 * confidence);
  const ParameterScale scale(info, index);
  ParameterEstimate out{value, standard_error, 0.0, 0.0, Observability::kObserved};
  if (scale.logarithmic() && (index == 0 ? evidence <= z : value <= z * standard_error)) {
    out.upper = value + z * standard_error;
    out.observability = Observability::kUpperBound;
    return out;
  }
  const double reach = z * standard_error / scale.slope(value);
  const double centre = scale.to_scale(value);
  out.lower = scale.to_value(centre - reach);
  out.upper = scale.to_value(centre + reach);
  if (index == 0 && standard_error > 0.0) out.lower *= selection_factor(evidence, z);
  if (!scale.logarithmic() && reach > 8.0) {
    out.observability = Observability::kIndistinguishable;  // spans almost all there is
  }
  return out;
}

void fill_intervals(Fit& fit, const ParameterSets& sets, const ParameterCovariance& covariance,
                    const PowerError& power_error, const PowerEvidence& evidence, double samples,
                    Hertz rate) {
  const auto place = [](const std::vector<Eigen::Index>& set, Eigen::Index column) {
    return std::find(set.begin(), set.end(), column) - set.begin();
  };
  fit.parameters.clear();
  fit.derived.clear();
  const double z = normal_quantile(0.5 + 0.5 * fit.confidence);
  const PowerLimit limit([&](HalfWidths m) { return variance(fit.estimate.model, m); }, samples);
  Eigen::Index first = 0;
  for (const Term& term : fit.estimate.model.terms) {
    const std::vector<ParameterInfo> about = parameters(term.process);
    const std::vector<double> v = values(term.process);
    const auto size = static_cast<Eigen::Index>(v.size());
    std::vector<ParameterEstimate> row;
    Eigen::MatrixXd local = Eigen::MatrixXd::Zero(size, size);
    for (Eigen::Index p = 0; p < size; ++p) {
      const auto index = static_cast<std::size_t>(p);
      const auto inside = static_cast<std::size_t>(place(sets.interior, first + p));
      const auto zero = static_cast<std::size_t>(place(sets.at_zero, first + p));
      if (term.given[index]) {
        row.push_back({v[index], 0.0, v[index], v[index], Observability::kGiven});
      } else if (inside < sets.interior.size()) {
        const auto at = static_cast<Eigen::Index>(inside);
        if (covariance.hidden(at)) {
          row.push_back({v[index], kInfinity, p == 0 ? 0.0 : about[index].lower,
                         p == 0 ? kInfinity : about[index].upper,
                         Observability::kIndistinguishable});
        } else {
          const double error = covariance.standard_error(at);
          const double by_error = v[index] / error;
          const bool known = p > 0 || clear(by_error);
          row.push_back(interval(about[index], index, v[index], error, fit.confidence,
                                 known ? by_error : evidence(first, by_error)));
        }
        for (Eigen::Index q = 0; q < size; ++q) {
          const auto other = static_cast<std::size_t>(place(sets.interior, first + q));
          if (other < sets.interior.size())
            local(p, q) = covariance.matrix(at, static_cast<Eigen::Index>(other));
        }
      } else if (zero < sets.at_zero.size()) {
        const double error = power_error(first, 0.0);
        row.push_back({0.0, error, 0.0, z * error, Observability::kUpperBound});
      } else {  // a shape whose power is zero, or that ran into its bound
        row.push_back({v[index], kInfinity, about[index].lower, about[index].upper,
                       Observability::kIndistinguishable});
      }
    }
    if (row[0].observability == Observability::kUpperBound) {
      row[0].upper = upper_bound(row[0].value, row[0].upper, z,
                                 [&](double at) { return power_error(first, at); });
    }
    if (!term.given[0])
      row[0].upper = std::min(row[0].upper, std::max(v[0], limit.most(term.process, row)));
    std::vector<DerivedEstimate> quantities;
    for (const DerivedQuantity& quantity : derived(term.process, rate)) {
      quantities.push_back(derived_interval(term, row, local, quantity, rate, z));
    }
    fit.parameters.push_back(std::move(row));
    fit.derived.push_back(std::move(quantities));
    first += size;
  }
}

}  // namespace imunoise
