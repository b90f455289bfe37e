#include "core/inference/efficient_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/inference/intervals.h"
#include "core/inference/parameter_covariance.h"
#include "core/inference/residuals.h"

namespace imunoise {
namespace {

ParameterCovariance bound(const Model& model, std::span<const BandedPower> powers,
                          const std::vector<Eigen::Index>& columns) {
  return inverse_information(whittle_information(model, powers, columns));
}

// The evidence for a power by the likelihood that it gains, where nothing else of its process was
// estimated: chance fits a shape, too.
double evidence_of(const Model& model, std::span<const BandedPower> powers, std::size_t term,
                   double by_error) {
  if (!alone(model.terms[term])) return by_error;
  Model without = model;
  without.terms.erase(without.terms.begin() + static_cast<std::ptrdiff_t>(term));
  if (without.terms.empty()) return std::numeric_limits<double>::infinity();
  const double gain = whittle(without, powers).objective - whittle_objective(model, powers);
  return std::sqrt(2.0 * std::max(0.0, gain));
}

double weighted_misfit(const Estimate& estimate, std::span<const WaveletVariance> replicates) {
  double out = 0.0;
  for (std::size_t k = 0; k < replicates.size(); ++k) {
    const Eigen::ArrayXd nu = variance(estimate.model, replicates[k].scales.half_widths());
    out += (estimate.weight_roots[k] * (replicates[k].variance - nu).matrix()).squaredNorm();
  }
  return out;
}

}  // namespace

void fill_likelihood_intervals(Fit& fit, std::span<const BandedPower> powers) {
  const Model& model = fit.estimate.model;
  const ParameterSets sets = parameter_sets(model);
  const auto power_error = [&](Eigen::Index column, double value) {
    const Model worth = with_power(model, column, value);
    return error_among(sets.interior, column, [&](const std::vector<Eigen::Index>& set) {
      return bound(worth, powers, set);
    });
  };
  const std::vector<ParameterPlace> places = parameter_places(model);
  const auto evidence = [&](Eigen::Index column, double by_error) {
    return evidence_of(model, powers, places[static_cast<std::size_t>(column)].term, by_error);
  };
  double samples = 0.0;
  for (const BandedPower& one : powers) samples += one.count.sum();
  fill_intervals(fit, sets, bound(model, powers, sets.interior), power_error, evidence, samples,
                 powers[0].rate);
}

Fit make_efficient(Fit fit, std::span<const WaveletVariance> replicates,
                   std::span<const BandedPower> powers, const Progress& progress) {
  WhittleEstimate found = whittle(fit.estimate.model, powers, progress);
  fit.estimate.model = std::move(found.model);
  fit.estimate.termination = found.termination;
  fit.estimate.objective = weighted_misfit(fit.estimate, replicates);
  const Model& model = fit.estimate.model;
  fit.covariances = moment_covariances(model, replicates);
  fill_residuals(fit, replicates, normal_scores(model, replicates, fit.covariances));
  fill_likelihood_intervals(fit, powers);
  return fit;
}

}  // namespace imunoise
