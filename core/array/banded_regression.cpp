#include "core/array/banded_regression.h"

#include "core/array/cross_spectra.h"
#include "core/support/linear_algebra.h"

namespace imunoise {
namespace {

Eigen::MatrixXd side_by_side(const RegressionData& data) {
  const Eigen::Index series = data.series();
  Eigen::MatrixXd out(data.response.rows(),
                      series * (1 + static_cast<Eigen::Index>(data.regressors.size())));
  out.leftCols(series) = data.response;
  Eigen::Index begin = series;
  for (const Eigen::MatrixXd& regressor : data.regressors) {
    out.middleCols(begin, series) = regressor;
    begin += series;
  }
  return out;
}

}  // namespace

Eigen::MatrixXd RegressionData::residual(const Eigen::VectorXd& coefficients) const {
  Eigen::MatrixXd out = response;
  for (std::size_t j = 0; j < regressors.size(); ++j)
    out -= coefficients(static_cast<Eigen::Index>(j)) * regressors[j];
  return out;
}

BandedRegression::BandedRegression(const RegressionData& data)
    : series_(data.series()),
      coefficients_(static_cast<Eigen::Index>(data.regressors.size())),
      all_(cross_power(side_by_side(data), data.rate)) {}

template <class InverseOfBand>
Coefficients BandedRegression::solve(const InverseOfBand& inverse_of_band) const {
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(coefficients_, coefficients_);
  Eigen::VectorXd moment = Eigen::VectorXd::Zero(coefficients_);
  for (std::size_t b = 0; b < all_.power.size(); ++b) {
    const Eigen::MatrixXd inverse =
        all_.count(static_cast<Eigen::Index>(b)) * inverse_of_band(static_cast<Eigen::Index>(b));
    for (Eigen::Index i = 0; i < coefficients_; ++i) {
      moment(i) += inverse.cwiseProduct(block(b, 1 + i, 0)).sum();
      for (Eigen::Index j = 0; j < coefficients_; ++j)
        gram(i, j) += inverse.cwiseProduct(block(b, 1 + i, 1 + j)).sum();
    }
  }
  const Eigen::MatrixXd covariance = pseudo_inverse(gram).matrix;
  return {covariance * moment, covariance};
}

Coefficients BandedRegression::under(const ArrayModel& model) const {
  const CrossSpectra spectra(model, all_.frequency);
  return solve([&](Eigen::Index b) { return positive_inverse(spectra(b)).matrix; });
}

Coefficients BandedRegression::naive() const {
  Coefficients out =
      solve([&](Eigen::Index) { return Eigen::MatrixXd::Identity(series_, series_); });
  const CrossPower left = residual(out.value);
  double squares = 0.0;
  for (std::size_t b = 0; b < left.power.size(); ++b)
    squares += left.count(static_cast<Eigen::Index>(b)) * left.power[b].trace();
  const double degrees =
      left.count.sum() * static_cast<double>(series_) - static_cast<double>(coefficients_);
  out.covariance *= squares / degrees;
  return out;
}

CrossPower BandedRegression::residual(const Eigen::VectorXd& coefficients) const {
  // What the residuals are of the response and the regressors' series.
  Eigen::MatrixXd combine = Eigen::MatrixXd::Zero(series_ * (1 + coefficients_), series_);
  combine.topRows(series_).setIdentity();
  for (Eigen::Index j = 0; j < coefficients_; ++j) {
    combine.middleRows((1 + j) * series_, series_) =
        -coefficients(j) * Eigen::MatrixXd::Identity(series_, series_);
  }
  CrossPower out = all_;
  for (Eigen::MatrixXd& power : out.power) power = combine.transpose() * power * combine;
  return out;
}

}  // namespace imunoise
