#include "core/faults/model_doubt.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/array/array_inference.h"

namespace imunoise {
namespace {

constexpr double kOfBlocks = 0.25;
constexpr double kInside = 0.99;  // of the distance to a bound

// Rows of weights on differences of blocks, newest first, that give the outputs.
Eigen::MatrixXd on_differences(const InnovationFilter& filter, const Eigen::MatrixXd& outputs) {
  const Eigen::MatrixXd& innovation = filter.from_differences();
  const Eigen::Index r = filter.outputs();
  const Eigen::Index p = filter.inputs();
  const Eigen::Index count = outputs.cols() / r;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(outputs.rows(), innovation.cols() + p * (count - 1));
  for (Eigen::Index j = 0; j < count; ++j)
    out.middleCols(p * j, innovation.cols()) += outputs.middleCols(r * j, r) * innovation;
  return out;
}

// Of each row of weights.
Eigen::ArrayXd variances(const ArrayModel& model, const InnovationFilter& filter,
                         const Eigen::MatrixXd& weights) {
  const Eigen::Index p = filter.inputs();
  const Eigen::Index n = weights.cols() / p;
  const std::vector<Eigen::MatrixXd> at_lag =
      difference_covariances(model, filter.projection(), filter.block(), n, 1.0);
  Eigen::MatrixXd covariance(n * p, n * p);
  for (Eigen::Index a = 0; a < n; ++a) {
    for (Eigen::Index b = 0; b < n; ++b)
      covariance.block(p * a, p * b, p, p) = at_lag[static_cast<std::size_t>(std::abs(a - b))];
  }
  return (weights * covariance).cwiseProduct(weights).rowwise().sum().array();
}

// The range of a parameter other than a power.
ParameterInfo range_of(const ArrayModel& model, const ArrayParameter& parameter) {
  return parameters(model.latents[parameter.latent].term.process)[parameter.parameter];
}

}  // namespace

ModelDoubt::ModelDoubt(const ArrayFit& fit, double readings)
    : model_(fit.model), readings_(readings), covariance_(fit.covariance) {
  for (std::size_t j = 0; j < fit.parameters.size(); ++j) {
    const ArrayParameter& parameter = fit.parameters[j];
    const auto at = static_cast<Eigen::Index>(j);
    const double value = value_of(fit.model, parameter);
    const double error = std::sqrt(std::max(0.0, covariance_(at, at)));
    double down = 0.0;
    double up = error;
    if (parameter.parameter > 0) {
      const ParameterInfo range = range_of(fit.model, parameter);
      // A standard error beyond the range says that nothing is known of it.
      const double most = (range.upper - range.lower) / std::sqrt(12.0);
      if (error > most) {
        covariance_.row(at) *= most / error;
        covariance_.col(at) *= most / error;
      }
      // The chord, not the slope: near a bound a shape changes much within little.
      down = std::clamp(std::min(error, most), 0.0, kInside * (value - range.lower));
      up = std::clamp(std::min(error, most), 0.0, kInside * (range.upper - value));
    }
    Direction one{fit.model, fit.model, down + up};
    set_value(one.below, parameter, value - down);
    set_value(one.above, parameter, value + up);
    directions_.push_back(std::move(one));
  }
}

double ModelDoubt::degrees(const InnovationFilter& filter, const Eigen::MatrixXd& outputs) const {
  if (directions_.empty()) return kNone;
  const Eigen::MatrixXd weights = on_differences(filter, outputs);
  const Eigen::ArrayXd believed = variances(model_, filter, weights);
  Eigen::MatrixXd slopes =
      Eigen::MatrixXd::Zero(believed.size(), static_cast<Eigen::Index>(directions_.size()));
  for (std::size_t j = 0; j < directions_.size(); ++j) {
    const auto& [below, above, distance] = directions_[j];
    if (!(distance > 0.0)) continue;
    const Eigen::ArrayXd change =
        variances(above, filter, weights) - variances(below, filter, weights);
    slopes.col(static_cast<Eigen::Index>(j)) = (change / (distance * believed)).matrix();
  }
  // The variance of the logarithm.
  const Eigen::ArrayXd spread = (slopes * covariance_).cwiseProduct(slopes).rowwise().sum().array();
  const double fewest = kOfBlocks * readings_ / static_cast<double>(filter.block());
  if (!spread.isFinite().all()) return fewest;
  return spread.maxCoeff() > 0.0 ? std::max(fewest, 2.0 / spread.maxCoeff()) : kNone;
}

}  // namespace imunoise
