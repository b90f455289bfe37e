#pragma once

#include <vector>

#include "core/array/latents.h"
#include "core/spectrum/cross_power.h"

namespace imunoise {

/// Y_i = α_i + Σ_j β_j X_ji + ε_i over the series i of an array. A coefficient belongs to one
/// regressor, whose values may differ between series; each series has its own constant.
struct RegressionData {
  Eigen::MatrixXd response;                 ///< samples × series
  std::vector<Eigen::MatrixXd> regressors;  ///< one a coefficient, each samples × series
  Hertz rate;

  Eigen::Index series() const { return response.cols(); }
  /// What the coefficients leave of the response.
  Eigen::MatrixXd residual(const Eigen::VectorXd& coefficients) const;
};

/// Coefficients with their covariance, were the noise the one that they were made under.
struct Coefficients {
  Eigen::VectorXd value;
  Eigen::MatrixXd covariance;
};

/// Generalised least squares in the bands of the cosine transform, where noise of any colour is
/// independent from band to band: no samples × samples matrix is ever made. The constants of the
/// series are not seen there and cost nothing.
class BandedRegression {
 public:
  /// Precondition: the number of samples is a quick_length(), of at least 16.
  explicit BandedRegression(const RegressionData& data);

  /// Under a noise model; regressors that depend linearly on others get zero.
  Coefficients under(const ArrayModel& model) const;
  /// Ordinary least squares with the errors that independent samples of one variance would have.
  Coefficients naive() const;
  /// Cross power of the residuals.
  CrossPower residual(const Eigen::VectorXd& coefficients) const;

 private:
  // Block (a, b) of a band: products of regressor a with regressor b; 0 is the response.
  auto block(std::size_t band, Eigen::Index a, Eigen::Index b) const {
    return all_.power[band].block(a * series_, b * series_, series_, series_);
  }
  template <class InverseOfBand>
  Coefficients solve(const InverseOfBand& inverse_of_band) const;

  Eigen::Index series_;
  Eigen::Index coefficients_;
  CrossPower all_;  // of the responses, then of each regressor's series
};

}  // namespace imunoise
