#include "core/faults/model_doubt.h"

#include <cmath>
#include <utility>

#include "core/array/array_inference.h"
#include "core/support/linear_algebra.h"

namespace imunoise {
namespace {

constexpr double kStep = 1e-4;  // of a standard error: variances are straight lines there

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
      difference_covariances(model, filter.projection(), filter.block(), n);
  Eigen::MatrixXd covariance(n * p, n * p);
  for (Eigen::Index a = 0; a < n; ++a) {
    for (Eigen::Index b = 0; b < n; ++b)
      covariance.block(p * a, p * b, p, p) = at_lag[static_cast<std::size_t>(std::abs(a - b))];
  }
  return (weights * covariance).cwiseProduct(weights).rowwise().sum().array();
}

}  // namespace

ModelDoubt::ModelDoubt(const ArrayFit& fit) : models_{fit.model} {
  const Eigen::VectorXd error = fit.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::VectorXd scale = (error.array() > 0.0).select(1.0 / error.array(), 0.0);
  const Eigen::MatrixXd correlation = scale.asDiagonal() * fit.covariance * scale.asDiagonal();
  const Eigen::MatrixXd directions = error.asDiagonal() * square_root(correlation);
  for (Eigen::Index i = 0; i < directions.cols(); ++i) {
    ArrayModel beside = fit.model;
    for (std::size_t j = 0; j < fit.parameters.size(); ++j) {
      const double value = value_of(fit.model, fit.parameters[j]);
      set_value(beside, fit.parameters[j],
                value + kStep * directions(static_cast<Eigen::Index>(j), i));
    }
    models_.push_back(std::move(beside));
  }
}

double ModelDoubt::degrees(const InnovationFilter& filter, const Eigen::MatrixXd& outputs) const {
  if (models_.size() < 2) return kNone;
  const Eigen::MatrixXd weights = on_differences(filter, outputs);
  const Eigen::ArrayXd believed = variances(models_.front(), filter, weights);
  Eigen::ArrayXd spread = Eigen::ArrayXd::Zero(believed.size());  // variance of the logarithm
  for (std::size_t i = 1; i < models_.size(); ++i) {
    const Eigen::ArrayXd change = (variances(models_[i], filter, weights) / believed - 1.0) / kStep;
    if (change.isFinite().all()) spread += change.square();  // not beyond a bound
  }
  return spread.maxCoeff() > 0.0 ? 2.0 / spread.maxCoeff() : kNone;
}

}  // namespace imunoise
