#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/array/array_moments.h"
#include "core/array/latents.h"
#include "core/inference/fit.h"

namespace imunoise {

struct ArrayOptions {
  Weighting weighting = Weighting::kFull;
  bool cross = true;  ///< use the cross-covariances too, not only each sensor's own variance
  double confidence = 0.95;
};

/// One free parameter of an array's model.
struct ArrayParameter {
  std::size_t latent;
  std::size_t parameter;  ///< of its process; 0 is its power
  Eigen::Index row = 0;   ///< sensors, of an entry of a power matrix; the first sensor otherwise
  Eigen::Index column = 0;
  ParameterEstimate estimate;
};

struct ArrayFit {
  ArrayModel model;
  double objective = 0.0;  ///< Σ (ν̂ - ν(θ̂))ᵀ Ω (ν̂ - ν(θ̂)), replicates of equal length averaged
  Termination termination = Termination::kLinear;
  bool joint_weights = true;  ///< false: pairs of sensors are weighted each by themselves
  std::vector<ArrayParameter> parameters;
  Eigen::MatrixXd covariance;  ///< of the parameters, in their order
};

/// MGMWM (Xu et al. 2019) and MiGMWM: one model for all sensors of an array and all replicates,
/// from their wavelet variances and cross-covariances. Power matrices are positive semidefinite.
/// With full weights Ω = V(θ̂)⁻¹ of all moments together while there are at most 1,200 of them, else
/// pair by pair. Deterministic. Precondition: at least one replicate, all of the layout's sensors
/// and of one rate.
ArrayFit fit_array(const Model& written, const ArrayLayout& layout,
                   std::span<const WaveletCovariance> replicates, const ArrayOptions& options = {},
                   const Progress& progress = {});

/// d moments / d parameters of a fit: the moments as in moments_of(), one column a parameter.
Eigen::MatrixXd parameter_slopes(const ArrayFit& fit, const Pairs& pairs, const Scales& scales);

}  // namespace imunoise
