#pragma once

#include <vector>

#include "core/dynamic/dynamic_fit.h"
#include "core/inference/parameter_covariance.h"

namespace imunoise {

/// One matrix a run, for every bin.
using RunRoots = std::vector<std::vector<Eigen::MatrixXd>>;
using BinCovariances = std::vector<MomentCovariances>;

/// The one problem of all bins, Ω = rootᵀ·root.
Problem dynamic_problem(const Model& model, const CovariateAxis& axis,
                        const std::vector<CovariateBin>& bins, const RunRoots& roots);

/// V of every run's moments under the model at its covariate.
BinCovariances bin_covariances(const Model& model, const CovariateAxis& axis,
                               const std::vector<CovariateBin>& bins);

/// Fills everything of a fit but the model, its separate fits and how the search ended. `roots` are
/// the weights of its estimate.
void infer(DynamicFit& fit, const std::vector<CovariateBin>& bins, const RunRoots& roots);

}  // namespace imunoise
