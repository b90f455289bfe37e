#pragma once

#include <Eigen/Core>
#include <cstdlib>
#include <vector>

#include "core/regression/current.h"

namespace imunoise {

/// Steps in one replicate as regressors under the noise: 0 before sample t, 1 from it on, less the
/// mean. At 0 and at the length of the replicate they are nothing.
class StepProducts {
 public:
  /// `weighted`: what a fit leaves, over the noise's spectrum, in time; `spectrum` at the
  /// coefficients of the cosine transform.
  StepProducts(const Eigen::VectorXd& weighted, const Eigen::ArrayXd& spectrum);

  Eigen::Index size() const { return product_.size() - 1; }
  /// Of the step before sample t with what the fit leaves.
  double product(Eigen::Index t) const { return product_(t); }
  /// Of the steps before samples s and t.
  double information(Eigen::Index s, Eigen::Index t) const {
    return wave(std::abs(s - t)) - wave(s + t);
  }
  /// Length of the path of unit steps over all times, rad.
  double path() const { return path_; }

 private:
  double wave(Eigen::Index d) const {
    return wave_[static_cast<std::size_t>(d <= size() ? d : 2 * size() - d)];
  }

  Eigen::VectorXd product_;
  std::vector<double> wave_;
  double path_ = 0.0;
};

/// One a replicate.
std::vector<StepProducts> step_products(const Current& current);

}  // namespace imunoise
