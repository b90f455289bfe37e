#pragma once

// Noise models as the matrices of a Kalman filter.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/array/latents.h"
#include "core/model/model.h"
#include "core/support/result.h"

namespace imunoise::study {

/// Noise y_k of one or several outputs, sample by sample:
///   x_{k+1} = Φ x_k + w,  Var w = Q;   y_k = H x_k + v,  Var v = R.
/// States are in the unit of the outputs (a slope in unit/s), matrices in SI.
struct StateSpace {
  double dt = 0.0;                   ///< s, of one step
  std::vector<std::string> outputs;  ///< names; rows of H, rows and columns of R
  std::vector<std::string> states;   ///< names; rows and columns of Φ, Q, P0
  Eigen::MatrixXd phi;
  Eigen::MatrixXd q;
  Eigen::MatrixXd h;
  Eigen::MatrixXd r;
  /// Covariance of the states at the start: the stationary one. Zero for the bias of a random walk
  /// or a ramp, to which the user adds the variance of the power-on bias.
  Eigen::MatrixXd p0;
};

/// Of one axis. A random walk and a ramp share one bias; quantisation noise has two states, never
/// R; flicker is a sum of Markov processes whose correlation times are 4 times apart, from half a
/// sample to 10⁷ samples. Error: a filter of more than 64 taps, or a model without values.
Result<StateSpace> state_space(const Model& noise, const std::string& output, Hertz rate);

/// Of an array, with the correlated processes in Q and R and the shared ones in H. Same errors.
Result<StateSpace> state_space(const ArrayModel& noise, const std::vector<std::string>& outputs,
                               Hertz rate);

/// The weighted sum of the outputs as one output: H = cᵀH, R = cᵀRc. Precondition: a weight for
/// each output.
StateSpace virtual_output(const StateSpace& array, const Eigen::VectorXd& weights);

}  // namespace imunoise::study
