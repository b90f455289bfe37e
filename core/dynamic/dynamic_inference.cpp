#include <algorithm>
#include <cmath>
#include <limits>

#include "core/dynamic/dynamic_blocks.h"
#include "core/inference/intervals.h"
#include "core/support/distributions.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Kind = FreeNumber::Kind;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Sandwich of some numbers of a fit, were the moments to scatter as `covariances` say.
ParameterCovariance sandwich(const DynamicFit& fit, const std::vector<FreeNumber>& numbers,
                             const std::vector<CovariateBin>& bins, const RunRoots& roots,
                             const BinCovariances& covariances) {
  Sandwich out(static_cast<Eigen::Index>(numbers.size()));
  for (std::size_t b = 0; b < bins.size(); ++b) {
    const double at = fit.axis(bins[b].covariate);
    for (std::size_t k = 0; k < bins[b].runs.size(); ++k) {
      out.add(roots[b][k], jacobian(fit.model, numbers, at, bins[b].runs[k].scales.half_widths()),
              covariances[b][k]);
    }
  }
  return out.covariance();
}

// Covariance of all numbers. A power at zero, or not clear of it, gets the variance that belongs to
// its upper bound: the largest one that could have been estimated as this little.
void fill_covariance(DynamicFit& fit, const std::vector<CovariateBin>& bins, const RunRoots& roots,
                     const BinCovariances& covariances) {
  fit.numbers = free_numbers(fit.model);
  std::vector<FreeNumber> inside;
  std::vector<Eigen::Index> place(fit.numbers.size(), -1);
  for (std::size_t i = 0; i < fit.numbers.size(); ++i) {
    if (fit.numbers[i].at_zero) continue;
    place[i] = static_cast<Eigen::Index>(inside.size());
    inside.push_back(fit.numbers[i]);
  }
  const ParameterCovariance main = sandwich(fit, inside, bins, roots, covariances);
  const auto n = static_cast<Eigen::Index>(fit.numbers.size());
  fit.covariance = Eigen::MatrixXd::Zero(n, n);
  fit.hidden.assign(fit.numbers.size(), false);
  const double z = normal_quantile(0.5 + 0.5 * fit.confidence);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const FreeNumber& number = fit.numbers[at];
    for (Eigen::Index j = 0; j < n && place[at] >= 0; ++j) {
      const Eigen::Index other = place[static_cast<std::size_t>(j)];
      if (other >= 0) fit.covariance(i, j) = main.matrix(place[at], other);
    }
    if (place[at] >= 0) fit.hidden[at] = main.hidden(place[at]);
    if (number.kind == Kind::kLevel || number.kind == Kind::kSlope) continue;
    std::vector<FreeNumber> with = inside;
    if (place[at] < 0) with.push_back(number);
    const Eigen::Index own = place[at] < 0 ? main.matrix.rows() : place[at];
    const auto error_at = [&](double power) {
      const Model moved = with_power(fit.model, number, power);
      return sandwich(fit, with, bins, roots, bin_covariances(moved, fit.axis, bins))
          .standard_error(own);
    };
    const double value = power_of(fit.model, number);
    const double error = place[at] < 0 ? error_at(0.0) : std::sqrt(fit.covariance(i, i));
    if (value > z * error) continue;
    const double reach = (upper_bound(value, value + z * error, z, error_at) - value) / z;
    fit.hidden[at] = fit.hidden[at] || !std::isfinite(reach);
    fit.covariance(i, i) = std::isfinite(reach) ? reach * reach : 0.0;
  }
}

// d(parameter at a covariate) / d(every number).
Eigen::VectorXd gradient(const DynamicFit& fit, std::size_t term, std::size_t parameter,
                         double at) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(fit.numbers.size()));
  for (std::size_t i = 0; i < fit.numbers.size(); ++i) {
    const FreeNumber& number = fit.numbers[i];
    if (number.term != term || number.parameter != parameter) continue;
    out(static_cast<Eigen::Index>(i)) = speed(fit.model, number, at);
  }
  return out;
}

// Is there a number behind a parameter, and can it be told from the others?
bool seen(const DynamicFit& fit, std::size_t term, std::size_t parameter) {
  bool any = false;
  for (std::size_t i = 0; i < fit.numbers.size(); ++i) {
    const FreeNumber& number = fit.numbers[i];
    if (number.term != term || number.parameter != parameter) continue;
    if (fit.hidden[i]) return false;
    any = any || number.kind != Kind::kSlope;
  }
  return any;
}

// Is an exponential power clear of zero at some covariate of the range? Its logarithm has variance
// a + 2bc + sc² there.
bool clear_of_zero(const DynamicFit& fit, std::size_t term) {
  double least = 0.0;
  double both = 0.0;
  double spread = 0.0;
  for (std::size_t i = 0; i < fit.numbers.size(); ++i) {
    const FreeNumber& level = fit.numbers[i];
    if (level.term != term || level.parameter != 0 || level.kind != Kind::kLevel) continue;
    const auto at = static_cast<Eigen::Index>(i);
    least = fit.covariance(at, at);
    if (i + 1 == fit.numbers.size()) continue;
    const FreeNumber& slope = fit.numbers[i + 1];
    if (slope.term != term || slope.parameter != 0 || slope.kind != Kind::kSlope) continue;
    both = fit.covariance(at, at + 1);
    spread = fit.covariance(at + 1, at + 1);
  }
  const double best = spread > 0.0 ? std::clamp(-both / spread, -1.0, 1.0) : 0.0;
  least += best * (2.0 * both + best * spread);
  return normal_quantile(0.5 + 0.5 * fit.confidence) * std::sqrt(std::max(0.0, least)) < 1.0;
}

ParameterEstimate estimate_at(const DynamicFit& fit, std::size_t t, std::size_t p, double value,
                              const Eigen::VectorXd& change) {
  const Term& term = fit.model.terms[t];
  const ParameterInfo about = parameters(term.process)[p];
  if (term.given[p] && term.trends[p].link == Link::kConstant) {
    return {value, 0.0, value, value, Observability::kGiven};
  }
  if (!seen(fit, t, p)) {
    return {value, kInfinity, p == 0 ? 0.0 : about.lower, p == 0 ? kInfinity : about.upper,
            Observability::kIndistinguishable};
  }
  const double error = std::sqrt(std::max(0.0, change.dot(fit.covariance * change)));
  if (p == 0 && term.trends[0].link == Link::kExponential && value > 0.0) {
    const double z = normal_quantile(0.5 + 0.5 * fit.confidence);
    if (!clear_of_zero(fit, t)) {
      return {value, error, 0.0, value + z * error, Observability::kUpperBound};
    }
    // Its logarithm is what is close to normal, however little of the power is left here.
    const double reach = z * error / value;
    return {value, error, value * std::exp(-reach), value * std::exp(reach),
            Observability::kObserved};
  }
  return interval(about, p, value, error, fit.confidence, value / error);
}

// How much the objective falls by a trend, the weights held.
TestOutcome test_of_trend(const DynamicFit& fit, std::size_t term, std::size_t parameter,
                          const std::vector<CovariateBin>& bins, const RunRoots& roots) {
  Model without = fit.model;
  without.terms[term].trends[parameter] = {};
  const Minimum found = minimise_from(dynamic_problem(without, fit.axis, bins, roots), without);
  return chi_square_test(found.objective - fit.objective, 1);
}

TrendEstimate trend_of(const DynamicFit& fit, std::size_t t, std::size_t p,
                       const std::vector<CovariateBin>& bins, const RunRoots& roots) {
  const Trend& trend = fit.model.terms[t].trends[p];
  TrendEstimate out;
  out.term = t;
  out.parameter = p;
  out.link = trend.link;
  out.slope = trend.slope / fit.axis.half;
  out.standard_error = kInfinity;
  Eigen::VectorXd change = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(fit.numbers.size()));
  for (std::size_t i = 0; i < fit.numbers.size(); ++i) {
    const FreeNumber& number = fit.numbers[i];
    if (number.term != t || number.parameter != p) continue;
    auto& to = change(static_cast<Eigen::Index>(i));
    if (number.kind == Kind::kSlope) to = 1.0;
    if (number.kind == Kind::kFirst) to = -0.5;
    if (number.kind == Kind::kLast) to = 0.5;
  }
  if (seen(fit, t, p) && !change.isZero(0.0)) {
    out.standard_error =
        std::sqrt(std::max(0.0, change.dot(fit.covariance * change))) / fit.axis.half;
  }
  const double reach = normal_quantile(0.5 + 0.5 * fit.confidence) * out.standard_error;
  out.lower = out.slope - reach;
  out.upper = out.slope + reach;
  out.test = test_of_trend(fit, t, p, bins, roots);
  return out;
}

// What explains the normal scores of all moments at the fit: each bin's own parameters, or the
// trends.
void fill_tests(DynamicFit& fit, const std::vector<CovariateBin>& bins,
                const BinCovariances& covariances) {
  std::vector<FreeNumber> inside;
  std::copy_if(fit.numbers.begin(), fit.numbers.end(), std::back_inserter(inside),
               [](const FreeNumber& number) { return !number.at_zero; });
  const auto n = static_cast<Eigen::Index>(inside.size());
  Eigen::VectorXd score = Eigen::VectorXd::Zero(n);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n, n);
  double by_bins = 0.0;
  double left = 0.0;
  Eigen::Index bins_rank = 0;
  int left_degrees = 0;
  for (std::size_t b = 0; b < bins.size(); ++b) {
    const double at = fit.axis(bins[b].covariate);
    const std::vector<WaveletVariance>& runs = bins[b].runs;
    const Model here = model_at(fit.model, at);
    const auto scores = normal_scores(here, runs, covariances[b]);
    const ScoreBlocks blocks(here, runs, scores);
    const TestOutcome unexplained = goodness_of_fit(blocks);
    for (std::size_t k = 0; k < runs.size(); ++k) {
      const Eigen::ArrayXd m = runs[k].scales.half_widths();
      const Eigen::ArrayXd expected = variance(here, m);
      const Eigen::MatrixXd slope = scores[k].slope(jacobian(fit.model, inside, at, m), expected);
      score += slope.transpose() * scores[k].residual(runs[k].variance, expected);
      information += slope.transpose() * slope;
      by_bins += blocks.squares[k];
      bins_rank += blocks.sizes[k];
    }
    by_bins -= unexplained.statistic;
    bins_rank -= unexplained.degrees_of_freedom;
    // Where the curves are far from a bin, only a fit of its own says what its parameters explain.
    fit.misfit_in.push_back(fit.separate[b] ? fit.separate[b]->goodness : unexplained);
    left += fit.misfit_in.back().statistic;
    left_degrees += fit.misfit_in.back().degrees_of_freedom;
  }
  const Explained by_trends = explained(score, information);
  fit.misfit = chi_square_test(left, left_degrees);
  fit.links = chi_square_test(by_bins - by_trends.squares,
                              std::max<Eigen::Index>(0, bins_rank - by_trends.rank));
}

}  // namespace

BinCovariances bin_covariances(const Model& model, const CovariateAxis& axis,
                               const std::vector<CovariateBin>& bins) {
  BinCovariances out(bins.size());
  for_each_index(bins.size(), [&](std::size_t b) {
    out[b] = moment_covariances(model_at(model, axis(bins[b].covariate)), bins[b].runs);
  });
  return out;
}

void infer(DynamicFit& fit, const std::vector<CovariateBin>& bins, const RunRoots& roots) {
  const BinCovariances covariances = bin_covariances(fit.model, fit.axis, bins);
  fill_covariance(fit, bins, roots, covariances);
  fill_tests(fit, bins, covariances);
  for (std::size_t t = 0; t < fit.model.terms.size(); ++t) {
    for (std::size_t p = 0; p < fit.model.terms[t].trends.size(); ++p) {
      if (fit.model.terms[t].trends[p].link == Link::kConstant) continue;
      fit.trends.push_back(trend_of(fit, t, p, bins, roots));
    }
  }
}

std::vector<TermEstimate> estimates_at(const DynamicFit& fit, double covariate) {
  const double at = fit.axis(covariate);
  const double z = normal_quantile(0.5 + 0.5 * fit.confidence);
  const Model here = model_at(fit.model, at);
  std::vector<TermEstimate> out;
  for (std::size_t t = 0; t < here.terms.size(); ++t) {
    const std::vector<double> v = values(here.terms[t].process);
    Eigen::MatrixXd change(static_cast<Eigen::Index>(fit.numbers.size()),
                           static_cast<Eigen::Index>(v.size()));
    TermEstimate term;
    for (std::size_t p = 0; p < v.size(); ++p) {
      const auto column = static_cast<Eigen::Index>(p);
      change.col(column) = gradient(fit, t, p, at);
      term.parameters.push_back(estimate_at(fit, t, p, v[p], change.col(column)));
    }
    const Eigen::MatrixXd local = change.transpose() * fit.covariance * change;
    for (const DerivedQuantity& quantity : derived(here.terms[t].process, fit.rate)) {
      term.derived.push_back(
          derived_interval(here.terms[t], term.parameters, local, quantity, fit.rate, z));
    }
    out.push_back(std::move(term));
  }
  return out;
}

}  // namespace imunoise
