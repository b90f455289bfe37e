#pragma once

#include <Eigen/Core>

#include "core/support/random.h"

namespace imunoise {

/// Noise as a linear system with n states and d sources of white noise of variance one:
/// x_t = output · s_t, s_{t+1} = transition · s_t + input · e_t.
struct LinearSystem {
  Eigen::MatrixXd transition;  ///< n × n
  Eigen::MatrixXd input;       ///< n × d
  Eigen::RowVectorXd output;   ///< n
  Eigen::MatrixXd stationary;  ///< covariance of s, n × n

  class Recursion {
   public:
    double next(RandomStream& rng);

   private:
    friend LinearSystem;
    Eigen::MatrixXd transition_;
    Eigen::MatrixXd input_;
    Eigen::RowVectorXd output_;
    Eigen::VectorXd state_;
    Eigen::VectorXd next_;
    Eigen::VectorXd source_;
  };
  /// One realisation from its stationary start, times sigma.
  Recursion recursion(double sigma, RandomStream& rng) const;
};

}  // namespace imunoise
