#include "core/array/array_inference.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/inference/intervals.h"
#include "core/support/distributions.h"
#include "core/support/linear_algebra.h"

namespace imunoise {
namespace {

// By how much the cross-covariance of a pair moves with a parameter, per unit of what its process
// contributes.
double factor(const Latent& latent, const ArrayParameter& parameter, const Pair& pair) {
  if (parameter.parameter > 0) return latent.power(pair.a, pair.b);
  if (latent.matrix()) return pair.a == parameter.row && pair.b == parameter.column ? 1.0 : 0.0;
  return latent.acts_on(pair.a) && latent.acts_on(pair.b) ? 1.0 : 0.0;
}

// Covariance of a fit's parameters, were the moments to scatter as under `scatter`.
ParameterCovariance sandwich(const ArrayFit& fit, const ArrayModel& scatter,
                             const std::vector<ArrayBlock>& blocks,
                             const std::vector<Eigen::MatrixXd>& roots,
                             const BlockCovariance& covariance) {
  Sandwich out(static_cast<Eigen::Index>(fit.parameters.size()));
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    out.add(roots[b], parameter_slopes(fit, blocks[b].pairs, blocks[b].group->scales),
            covariance(scatter, blocks[b]));
  }
  return out.covariance();
}

// The wavelet variance of a sensor under a model.
Eigen::ArrayXd variance_of_sensor(const ArrayModel& model, Eigen::Index sensor, HalfWidths m) {
  Eigen::ArrayXd out = Eigen::ArrayXd::Zero(m.size());
  for (const Latent& one : model.latents)
    out += one.power(sensor, sensor) * shape(one.term.process, m);
  return out;
}

// No process has more than the noise of its sensor.
void limit_powers(ArrayFit& fit, double samples) {
  for (ArrayParameter& power : fit.parameters) {
    const bool own = power.parameter == 0 && power.row == power.column;
    if (!own) continue;
    const Latent& latent = fit.model.latents[power.latent];
    std::vector<ParameterEstimate> estimates;
    for (const double value : values(latent.term.process))
      estimates.push_back({value, 0.0, value, value, Observability::kGiven});
    for (const ArrayParameter& one : fit.parameters)
      if (one.latent == power.latent && one.parameter > 0) estimates[one.parameter] = one.estimate;
    const PowerLimit limit(
        [&](HalfWidths m) { return variance_of_sensor(fit.model, power.row, m); }, samples);
    power.estimate.upper =
        std::min(power.estimate.upper,
                 std::max(power.estimate.value, limit.most(latent.term.process, estimates)));
  }
}

}  // namespace

std::vector<ArrayParameter> parameters_of(const ArrayModel& model) {
  std::vector<ArrayParameter> out;
  for (std::size_t t = 0; t < model.latents.size(); ++t) {
    const Latent& latent = model.latents[t];
    const Eigen::Index first = latent.sensors.front();
    if (latent.matrix()) {
      for (const auto& [a, b] : all_pairs(model.sensors)) out.push_back({t, 0, a, b, {}});
    } else if (!latent.term.given[0]) {
      out.push_back({t, 0, first, first, {}});
    }
    for (std::size_t p = 1; p < latent.term.given.size(); ++p) {
      if (!latent.term.given[p]) out.push_back({t, p, first, first, {}});
    }
  }
  return out;
}

double value_of(const ArrayModel& model, const ArrayParameter& parameter) {
  const Latent& latent = model.latents[parameter.latent];
  if (parameter.parameter > 0) return values(latent.term.process)[parameter.parameter];
  return latent.power(parameter.row, parameter.column);
}

void set_value(ArrayModel& model, const ArrayParameter& parameter, double value) {
  Latent& latent = model.latents[parameter.latent];
  if (parameter.parameter > 0) {
    std::vector<double> all = values(latent.term.process);
    all[parameter.parameter] = value;
    set_values(latent.term.process, all);
  } else if (latent.matrix()) {
    latent.power(parameter.row, parameter.column) = value;
    latent.power(parameter.column, parameter.row) = value;
  } else {
    latent.set_scalar(value);
  }
}

Eigen::MatrixXd parameter_slopes(const ArrayFit& fit, const Pairs& pairs, const Scales& scales) {
  const Eigen::ArrayXd m = scales.half_widths();
  const auto n = m.size();
  Eigen::MatrixXd out(n * static_cast<Eigen::Index>(pairs.size()),
                      static_cast<Eigen::Index>(fit.parameters.size()));
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    const ArrayParameter& parameter = fit.parameters[i];
    const Latent& latent = fit.model.latents[parameter.latent];
    const Eigen::VectorXd change =
        jacobian(latent.term.process, m).col(static_cast<Eigen::Index>(parameter.parameter));
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      out.col(static_cast<Eigen::Index>(i)).segment(static_cast<Eigen::Index>(p) * n, n) =
          factor(latent, parameter, pairs[p]) * change;
    }
  }
  return out;
}

void fill_estimates(ArrayFit& fit, double confidence, double samples,
                    const CovarianceUnder& covariance_under) {
  const ParameterCovariance here = covariance_under(fit.model);
  fit.covariance = here.matrix;
  const double z = normal_quantile(0.5 + 0.5 * confidence);
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    ArrayParameter& parameter = fit.parameters[i];
    const auto at = static_cast<Eigen::Index>(i);
    const Latent& latent = fit.model.latents[parameter.latent];
    const double value = value_of(fit.model, parameter);
    const bool hidden = here.hidden(at);
    const double error = here.standard_error(at);
    if (hidden || parameter.row != parameter.column) {  // a covariance has no sign to respect
      parameter.estimate = {value, error, value - z * error, value + z * error,
                            hidden ? Observability::kIndistinguishable : Observability::kObserved};
      continue;
    }
    const ParameterInfo about = parameters(latent.term.process)[parameter.parameter];
    parameter.estimate =
        interval(about, parameter.parameter, value, error, confidence, value / error);
    if (parameter.parameter == 0 &&
        parameter.estimate.observability == Observability::kUpperBound) {
      const auto error_at = [&](double power) {
        ArrayModel moved = fit.model;
        set_value(moved, parameter, power);
        return std::sqrt(std::max(covariance_under(moved).matrix(at, at), 0.0));
      };
      parameter.estimate.upper = upper_bound(value, parameter.estimate.upper, z, error_at);
    }
  }
  limit_powers(fit, samples);
}

void infer(ArrayFit& fit, const std::vector<ArrayBlock>& blocks,
           const std::vector<Eigen::MatrixXd>& roots, double confidence) {
  fit.parameters = parameters_of(fit.model);
  const BlockCovariance covariance(fit.model, blocks);
  std::set<const ReplicateGroup*> groups;
  for (const ArrayBlock& one : blocks) groups.insert(one.group);
  double samples = 0.0;
  for (const ReplicateGroup* const one : groups)
    samples += one->count * static_cast<double>(one->samples);
  fill_estimates(fit, confidence, samples, [&](const ArrayModel& scatter) {
    return sandwich(fit, scatter, blocks, roots, covariance);
  });
}

}  // namespace imunoise
