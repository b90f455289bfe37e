#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/model/model.h"

namespace imunoise {

/// The sensors of an array, and the group of each for terms that a group shares.
struct ArrayLayout {
  std::size_t sensors = 0;
  std::vector<std::size_t> group{};  ///< of each sensor; empty: all in one group
};

/// One process behind the readings of an array: it adds power(a, b) · shape(m) to the wavelet
/// cross-covariance of sensors a and b.
struct Latent {
  Term term;                            ///< its shape; its own power is 1
  std::size_t written = 0;              ///< which term of the model as written it stands for
  std::vector<Eigen::Index> sensors{};  ///< that it acts on
  Eigen::MatrixXd power{};  ///< I × I, zero outside its sensors, in the unit of the process's power

  /// Its power is a free positive semidefinite matrix; else one number for all its sensors.
  bool matrix() const { return term.sharing == Sharing::kCorrelated; }
  bool acts_on(Eigen::Index sensor) const;
  /// The number, where it is one.
  double scalar() const { return power(sensors.front(), sensors.front()); }
  void set_scalar(double value);
};

/// A noise model of an array.
struct ArrayModel {
  Eigen::Index sensors = 0;
  std::vector<Latent> latents;
};

/// One latent process for each thing that a model's terms stand for: a term of its own in every
/// sensor, one for each group, one for all, or one with a matrix of powers. A ramp of several
/// sensors always has a matrix: ω_a ω_b does not vanish for a ≠ b, so DR means DR[corr]. Powers are
/// 1 (or the unit matrix) where they are not given.
ArrayModel expand(const Model& written, const ArrayLayout& layout);

/// Wavelet cross-covariances of the model: one I × I matrix a scale.
std::vector<Eigen::MatrixXd> covariance(const ArrayModel& model, const Scales& scales);

/// Brings equal processes of the same sensors into their unique order, as sorted() does for a
/// signal.
ArrayModel sorted(ArrayModel model);

}  // namespace imunoise
