#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/array/latents.h"

namespace imunoise {

/// Rows that span everything an array's sensors say but their common motion: orthonormal, each of
/// sum zero (I sensors of which the listed ones are used: n - 1 rows × I columns). They are the
/// parity space of redundant sensors (Potter & Suman 1977): P(1·w + e) = P e, whatever w is.
Eigen::MatrixXd parity_rows(Eigen::Index sensors, const std::vector<Eigen::Index>& used);

/// One row that picks one sensor.
Eigen::MatrixXd sensor_row(Eigen::Index sensors, Eigen::Index used);

/// Whether an array's parity is noisy in every direction: where it is not, its sensors agree
/// exactly and the smallest difference would be a fault.
bool parity_is_noisy(const ArrayModel& model);

/// R(h), h = 0 .. count - 1, of the differences of block means, projected on p rows (p × p each):
/// see InnovationFilter. `ramp` multiplies the variance of a ramp.
std::vector<Eigen::MatrixXd> difference_covariances(const ArrayModel& model,
                                                    const Eigen::MatrixXd& projection,
                                                    std::int64_t block, Eigen::Index count,
                                                    double ramp);

/// Makes white noise out of an array's noise. The means x_k of successive blocks of readings,
/// projected on p rows, are predicted from the kHistory blocks before, without knowing their
/// constant level, and the errors of the prediction are scaled to unit covariance.
///
/// The differences u_k = x_k - x_(k-1) are stationary for every process of the house, with
/// autocovariance R(h) = 4 Σ_latents γ(hL) P·power·Pᵀ, γ the covariance of Haar coefficients of
/// half-width L, known in closed form; the predictor of order kHistory - 1 follows by Whittle's
/// recursion (1963). A finite history leaves innovations that correlate by about kHistory⁻². A
/// ramp counts as unknown: its variance is taken 10⁴ times as large.
class InnovationFilter {
 public:
  /// Blocks that a prediction looks back.
  static constexpr Eigen::Index kHistory = 32;

  /// `projection` is p × I, `block` = L ≥ 1 the samples in a block.
  InnovationFilter(const ArrayModel& model, const Eigen::MatrixXd& projection, std::int64_t block);

  const Eigen::MatrixXd& projection() const { return projection_; }
  std::int64_t block() const { return block_; }
  Eigen::Index inputs() const { return projection_.rows(); }  ///< p
  Eigen::Index outputs() const {
    return from_differences_.rows();
  }  ///< r ≤ p: noise-free ones drop
  /// Times kHistory differences, the newest first (p·kHistory): the white innovation (r).
  const Eigen::MatrixXd& from_differences() const { return from_differences_; }
  /// What a unit step of one sensor at the beginning of a block does to the innovations: column j
  /// is that of the j-th block from there (r × count, count ≤ kHistory).
  Eigen::MatrixXd step_response(Eigen::Index sensor, Eigen::Index count) const;
  /// Variances of a single row's differences given 0, 1, 2 .. earlier ones. Precondition: p = 1.
  const Eigen::VectorXd& conditional_variances() const { return conditional_; }

 private:
  Eigen::MatrixXd projection_;  // p × I
  std::int64_t block_;
  Eigen::MatrixXd from_differences_;  // r × p·kHistory
  Eigen::VectorXd conditional_;       // kHistory, where p = 1
};

/// The innovations of a stream of block means.
class InnovationStream {
 public:
  explicit InnovationStream(InnovationFilter filter);
  const InnovationFilter& filter() const { return filter_; }
  /// Takes the next block's mean (p); true when there are enough to predict it, and innovation() is
  /// its error.
  bool feed(const Eigen::Ref<const Eigen::VectorXd>& mean);
  const Eigen::VectorXd& innovation() const { return innovation_; }

 private:
  InnovationFilter filter_;
  Eigen::VectorXd before_;       // the mean of the block before
  Eigen::VectorXd differences_;  // newest first
  Eigen::VectorXd innovation_;
  Eigen::Index seen_ = 0;  // blocks
};

}  // namespace imunoise
