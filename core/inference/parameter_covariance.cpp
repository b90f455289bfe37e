#include "core/inference/parameter_covariance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/process/parameter_scale.h"

namespace imunoise {

ParameterSets parameter_sets(const Model& model) {
  ParameterSets out;
  const std::vector<ParameterPlace> places = parameter_places(model);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto [t, p] = places[i];
    const Term& term = model.terms[t];
    if (term.given[p]) continue;
    const auto column = static_cast<Eigen::Index>(i);
    const std::vector<double> v = values(term.process);
    if (p == 0) {
      (v[0] > 0.0 ? out.interior : out.at_zero).push_back(column);
      continue;
    }
    const ParameterInfo about = parameters(term.process)[p];
    if (v[0] > 0.0 && !at_bound(about, v[p])) out.interior.push_back(column);
  }
  return out;
}

Eigen::MatrixXd pick_columns(const Eigen::MatrixXd& matrix,
                             const std::vector<Eigen::Index>& columns) {
  Eigen::MatrixXd out(matrix.rows(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i)
    out.col(static_cast<Eigen::Index>(i)) = matrix.col(columns[i]);
  return out;
}

double ParameterCovariance::standard_error(Eigen::Index parameter) const {
  if (hidden(parameter)) return std::numeric_limits<double>::infinity();
  return std::sqrt(std::max(matrix(parameter, parameter), 0.0));
}

Sandwich::Sandwich(Eigen::Index parameters)
    : bread_(Eigen::MatrixXd::Zero(parameters, parameters)), meat_(bread_) {}

void Sandwich::add(const Eigen::MatrixXd& weight_root, const Eigen::MatrixXd& jacobian,
                   const Eigen::MatrixXd& covariance) {
  const Eigen::MatrixXd slope = weight_root * jacobian;
  const Eigen::MatrixXd spread = weight_root * covariance * weight_root.transpose();
  bread_ += slope.transpose() * slope;
  meat_ += slope.transpose() * spread * slope;
}

ParameterCovariance Sandwich::covariance() const {
  const PseudoInverse inverse = pseudo_inverse(bread_);
  return {inverse.matrix * meat_ * inverse.matrix, inverse.null_share};
}

ParameterCovariance inverse_information(const Eigen::MatrixXd& information) {
  const PseudoInverse inverse = pseudo_inverse(information);
  return {inverse.matrix, inverse.null_share};
}

ParameterCovariance parameter_covariance(const Model& model,
                                         std::span<const WaveletVariance> replicates,
                                         const std::vector<Eigen::MatrixXd>& weight_roots,
                                         const MomentCovariances& covariances,
                                         const std::vector<Eigen::Index>& set) {
  Sandwich sandwich(static_cast<Eigen::Index>(set.size()));
  for (std::size_t k = 0; k < replicates.size(); ++k) {
    sandwich.add(weight_roots[k],
                 pick_columns(jacobian(model, replicates[k].scales.half_widths()), set),
                 covariances[k]);
  }
  return sandwich.covariance();
}

Model with_power(Model model, Eigen::Index column, double value) {
  const ParameterPlace place = parameter_places(model)[static_cast<std::size_t>(column)];
  Process& process = model.terms[place.term].process;
  std::vector<double> v = values(process);
  v[place.parameter] = value;
  set_values(process, v);
  return model;
}

double error_among(
    std::vector<Eigen::Index> interior, Eigen::Index column,
    const std::function<ParameterCovariance(const std::vector<Eigen::Index>&)>& covariance_of) {
  auto found = std::find(interior.begin(), interior.end(), column);
  if (found == interior.end()) found = interior.insert(found, column);
  const auto at = static_cast<Eigen::Index>(found - interior.begin());
  return covariance_of(interior).standard_error(at);
}

}  // namespace imunoise
