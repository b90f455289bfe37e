#include "core/faults/innovations.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/support/linear_algebra.h"
#include "core/wavelet/scale_covariance.h"

namespace imunoise {
namespace {

constexpr double kUnknownRamp = 1e4;
constexpr double kRounding = 1e-12;  // of a power: what projecting common noise leaves

// A predictor u_k ≈ Σ_j coefficients[j] u_(k-1-j) and the covariance of its error.
struct Predictor {
  std::vector<Eigen::MatrixXd> coefficients;
  Eigen::MatrixXd error;
};

// One order more. The series looks the same backwards, so one set of coefficients serves both ways.
void extend(Predictor& to, const std::vector<Eigen::MatrixXd>& r) {
  const std::vector<Eigen::MatrixXd> a = to.coefficients;
  const std::size_t order = a.size();
  Eigen::MatrixXd missed = r[order + 1];
  for (std::size_t j = 0; j < order; ++j) missed -= a[j] * r[order - j];
  const Eigen::MatrixXd gain = missed * pseudo_inverse(to.error).matrix;
  for (std::size_t j = 0; j < order; ++j) to.coefficients[j] -= gain * a[order - 1 - j];
  to.coefficients.push_back(gain);
  const Eigen::MatrixXd error = to.error - gain * missed.transpose();
  to.error = 0.5 * (error + error.transpose());
}

}  // namespace

std::vector<Eigen::MatrixXd> difference_covariances(const ArrayModel& model,
                                                    const Eigen::MatrixXd& projection,
                                                    std::int64_t block, Eigen::Index count,
                                                    double ramp) {
  const Eigen::Index p = projection.rows();
  std::vector<Eigen::MatrixXd> out(static_cast<std::size_t>(count), Eigen::MatrixXd::Zero(p, p));
  const auto length = static_cast<double>(block);
  for (const Latent& latent : model.latents) {
    const Eigen::MatrixXd power = projection * latent.power * projection.transpose();
    if (power.norm() <= kRounding * latent.power.norm()) continue;
    const SumCovariance sums = sum_covariance(latent.term.process);
    const ScaleCovariance haar(sums, block, block);
    const double slope = ramp * sums.slope_squared * length * length;
    for (Eigen::Index h = 0; h < count; ++h) {
      const double lag = length * static_cast<double>(h);
      out[static_cast<std::size_t>(h)] += (4.0 * haar(lag) + slope) * power;
    }
  }
  return out;
}

Eigen::MatrixXd parity_rows(Eigen::Index sensors, const std::vector<Eigen::Index>& used) {
  const auto n = static_cast<Eigen::Index>(used.size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n - 1, sensors);
  for (Eigen::Index k = 1; k < n; ++k) {  // the mean of the first k against the next (Helmert)
    const auto size = static_cast<double>(k);
    const double unit = 1.0 / std::sqrt(size * (size + 1.0));
    for (Eigen::Index i = 0; i < k; ++i) out(k - 1, used[static_cast<std::size_t>(i)]) = unit;
    out(k - 1, used[static_cast<std::size_t>(k)]) = -size * unit;
  }
  return out;
}

Eigen::MatrixXd sensor_row(Eigen::Index sensors, Eigen::Index used) {
  return Eigen::RowVectorXd::Unit(sensors, used);
}

bool parity_is_noisy(const ArrayModel& model) {
  std::vector<Eigen::Index> all(static_cast<std::size_t>(model.sensors));
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  const Eigen::MatrixXd rows = parity_rows(model.sensors, all);
  const Eigen::MatrixXd covariance =
      difference_covariances(model, rows, 1, 1, kUnknownRamp).front();
  return covariance.diagonal().minCoeff() > 0.0 && pseudo_inverse(covariance).rank == rows.rows();
}

InnovationFilter::InnovationFilter(const ArrayModel& model, const Eigen::MatrixXd& projection,
                                   std::int64_t block)
    : projection_(projection), block_(block) {
  const Eigen::Index p = projection.rows();
  const std::vector<Eigen::MatrixXd> r =
      difference_covariances(model, projection, block, kHistory, kUnknownRamp);
  Predictor predictor{{}, r.front()};
  if (p == 1) conditional_.resize(kHistory);
  for (Eigen::Index order = 0; order < kHistory; ++order) {
    if (p == 1) conditional_(order) = predictor.error(0, 0);
    if (order + 1 < kHistory) extend(predictor, r);
  }
  Eigen::MatrixXd from(p, p * kHistory);
  from.leftCols(p).setIdentity();
  for (Eigen::Index j = 1; j < kHistory; ++j) {
    from.middleCols(p * j, p) = -predictor.coefficients[static_cast<std::size_t>(j - 1)];
  }
  from_differences_ = whiten(predictor.error).matrix * from;
}

Eigen::MatrixXd InnovationFilter::step_response(Eigen::Index sensor, Eigen::Index count) const {
  const Eigen::Index p = inputs();
  Eigen::MatrixXd out(outputs(), count);
  for (Eigen::Index j = 0; j < count; ++j) {
    out.col(j) = from_differences_.middleCols(p * j, p) * projection_.col(sensor);
  }
  return out;
}

InnovationStream::InnovationStream(InnovationFilter filter)
    : filter_(std::move(filter)),
      before_(filter_.inputs()),
      differences_(Eigen::VectorXd::Zero(filter_.inputs() * InnovationFilter::kHistory)),
      innovation_(Eigen::VectorXd::Zero(filter_.outputs())) {}

bool InnovationStream::feed(const Eigen::Ref<const Eigen::VectorXd>& mean) {
  const Eigen::Index p = filter_.inputs();
  if (seen_ > 0) {
    std::copy_backward(differences_.begin(), differences_.end() - p, differences_.end());
    differences_.head(p) = mean - before_;
  }
  before_ = mean;
  if (seen_ < InnovationFilter::kHistory) {
    ++seen_;
    return false;
  }
  innovation_.noalias() = filter_.from_differences() * differences_;
  return true;
}

}  // namespace imunoise
