#include "core/inference/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/inference/goodness.h"
#include "core/inference/intervals.h"
#include "core/inference/parameter_covariance.h"
#include "core/inference/residuals.h"
#include "core/support/distributions.h"

namespace imunoise {
namespace {

// Standard error of a power, were it worth `value`: the moments scatter accordingly.
double error_of_power(const Model& model, std::span<const WaveletVariance> replicates,
                      const std::vector<Eigen::MatrixXd>& weight_roots,
                      const std::vector<Eigen::Index>& interior, Eigen::Index column,
                      double value) {
  const MomentCovariances covariances =
      moment_covariances(with_power(model, column, value), replicates);
  return error_among(interior, column, [&](const std::vector<Eigen::Index>& set) {
    return parameter_covariance(model, replicates, weight_roots, covariances, set);
  });
}

// Where nothing else of its process is estimated, the evidence for a power is the estimate over the
// standard error that it would have if there were none.
void fill_by_errors(Fit& fit, const ParameterSets& sets, const ParameterCovariance& covariance,
                    const PowerError& power_error, std::span<const WaveletVariance> replicates) {
  const Model& model = fit.estimate.model;
  const std::vector<ParameterPlace> places = parameter_places(model);
  const auto evidence = [&](Eigen::Index column, double by_error) {
    const Term& term = model.terms[places[static_cast<std::size_t>(column)].term];
    if (!alone(term)) return by_error;
    return std::max(by_error, values(term.process)[0] / power_error(column, 0.0));
  };
  double samples = 0.0;
  for (const WaveletVariance& one : replicates) samples += static_cast<double>(one.samples);
  fill_intervals(fit, sets, covariance, power_error, evidence, samples, replicates[0].rate);
}

TestOutcome test_of_fit(const Model& model, std::span<const WaveletVariance> replicates,
                        const PerReplicate<NormalScores>& scores) {
  return goodness_of_fit(ScoreBlocks(model, replicates, scores));
}

// The test is of the model, not of the estimate: it is made at the efficient one. Diagonal weights
// follow the noise of the moments, which biases their estimate, and with it the covariance that the
// test needs.
TestOutcome test_at_full_weights(const Model& open, std::span<const WaveletVariance> replicates) {
  const Model model = mugmwm(open, replicates, Weighting::kFull).model;
  return test_of_fit(model, replicates,
                     normal_scores(model, replicates, moment_covariances(model, replicates)));
}

}  // namespace

Fit infer(Estimate estimate, std::span<const WaveletVariance> replicates, double confidence) {
  Fit fit;
  fit.confidence = confidence;
  fit.estimate = std::move(estimate);
  const Model& model = fit.estimate.model;
  fit.covariances = moment_covariances(model, replicates);
  const PerReplicate<NormalScores> scores = normal_scores(model, replicates, fit.covariances);
  fill_residuals(fit, replicates, scores);
  const ParameterSets sets = parameter_sets(model);
  const auto& roots = fit.estimate.weight_roots;
  const ParameterCovariance covariance =
      parameter_covariance(model, replicates, roots, fit.covariances, sets.interior);
  const auto power_error = [&](Eigen::Index column, double value) {
    return error_of_power(model, replicates, roots, sets.interior, column, value);
  };
  fill_by_errors(fit, sets, covariance, power_error, replicates);
  fit.goodness = fit.estimate.weighting == Weighting::kFull
                     ? test_of_fit(model, replicates, scores)
                     : test_at_full_weights(model, replicates);
  return fit;
}

Fit infer(const AverageEstimate& average, std::span<const WaveletVariance> replicates,
          double confidence) {
  Fit fit;
  fit.confidence = confidence;
  fit.estimate = average.average;
  const Model& model = fit.estimate.model;
  fit.covariances = moment_covariances(model, replicates);
  fill_residuals(fit, replicates, normal_scores(model, replicates, fit.covariances));
  const ParameterSets sets = parameter_sets(model);
  const auto size = static_cast<Eigen::Index>(sets.interior.size());
  ParameterCovariance mean{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
  const auto count = static_cast<double>(replicates.size());
  for (std::size_t k = 0; k < replicates.size(); ++k) {
    const auto one = replicates.subspan(k, 1);
    const std::vector<Eigen::MatrixXd> root = {fit.estimate.weight_roots[k]};
    const MomentCovariances covariances = moment_covariances(model, one);
    const ParameterCovariance c =
        parameter_covariance(model, one, root, covariances, sets.interior);
    mean.matrix += c.matrix / (count * count);
    mean.null_share = mean.null_share.cwiseMax(c.null_share);
    const Fit separate = infer(average.separate[k], one, confidence);
    fit.goodness =
        chi_square_test(fit.goodness.statistic + separate.goodness.statistic,
                        fit.goodness.degrees_of_freedom + separate.goodness.degrees_of_freedom);
  }
  const auto power_error = [&](Eigen::Index column, double value) {
    double squares = 0.0;
    for (std::size_t k = 0; k < replicates.size(); ++k) {
      const double one =
          error_of_power(model, replicates.subspan(k, 1), {fit.estimate.weight_roots[k]},
                         sets.interior, column, value);
      squares += one * one;
    }
    return std::sqrt(squares) / count;
  };
  fill_by_errors(fit, sets, mean, power_error, replicates);
  return fit;
}

double record_longer(const Fit& fit, std::span<const WaveletVariance> replicates, std::size_t term,
                     std::size_t parameter) {
  const ParameterEstimate& estimate = fit.parameters[term][parameter];
  if (estimate.observability == Observability::kObserved) return 1.0;
  if (estimate.value <= 0.0 || parameter != 0) return 0.0;
  const Model& model = fit.estimate.model;
  const std::vector<ParameterPlace> places = parameter_places(model);
  const auto column = std::find_if(places.begin(), places.end(),
                                   [&](const ParameterPlace& one) { return one.term == term; }) -
                      places.begin();
  const ParameterSets sets = parameter_sets(model);
  const auto found = std::find(sets.interior.begin(), sets.interior.end(), column);
  if (found == sets.interior.end()) return 0.0;
  const double z = normal_quantile(0.5 + 0.5 * fit.confidence);
  const auto at = static_cast<Eigen::Index>(found - sets.interior.begin());
  const Model none = alone(model.terms[term]) ? with_power(model, column, 0.0) : model;
  // What must fall below 1 for half of such recordings to show it: what an estimate must reach,
  // over their median if they are distributed as χ² (Wilson & Hilferty 1931, PNAS 17:684).
  const auto missing = [&](std::span<const WaveletVariance> of,
                           const std::vector<Eigen::MatrixXd>& roots) {
    const auto error_under = [&](const Model& truth) {
      return parameter_covariance(truth, of, roots, moment_covariances(truth, of), sets.interior)
          .standard_error(at);
    };
    const double ratio = estimate.value / error_under(model);
    const double median = estimate.value * std::pow(1.0 - 1.0 / (9.0 * ratio * ratio), 3);
    return median > 0.0 ? z * error_under(none) / median : std::numeric_limits<double>::infinity();
  };
  double before = missing(replicates, fit.estimate.weight_roots);
  constexpr double kLongest = 256.0;
  // By doublings: in between, no averaging time comes to those there are.
  for (double factor = 2.0; factor <= kLongest; factor *= 2.0) {
    std::vector<WaveletVariance> longer(replicates.begin(), replicates.end());
    for (WaveletVariance& wv : longer) {
      const auto times = static_cast<std::int64_t>(factor);
      std::vector<std::int64_t> scales(wv.scales.begin(), wv.scales.end());
      const std::int64_t top = wv.scales.largest();
      for (std::int64_t octave = 2; octave <= times; octave *= 2) {
        for (const std::int64_t m : wv.scales) {
          if (2 * m > top) scales.push_back(m * octave);
        }
      }
      wv.scales = Scales(std::move(scales));
      wv.samples *= static_cast<std::size_t>(times);
    }
    const MomentCovariances covariances = moment_covariances(model, longer);
    std::vector<Eigen::MatrixXd> roots;
    for (std::size_t k = 0; k < longer.size(); ++k) roots.push_back(whiten(covariances[k]).matrix);
    const double now = missing(longer, roots);
    if (now < 1.0) return factor;
    // The longer, the more it costs to look: no further than errors can fall that fall half as much
    // again as they do, or as those of a mean.
    constexpr double kMargin = 1.5;
    const double fall = kMargin * std::max(std::numbers::sqrt2, before / now);
    const double steps = std::log2(kLongest / factor);
    if (std::isfinite(now) && now > std::pow(fall, steps)) return 0.0;
    before = now;
  }
  return 0.0;
}

}  // namespace imunoise
