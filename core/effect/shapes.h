#pragma once

#include <Eigen/Core>
#include <functional>

namespace imunoise {

/// A course of known form, a sum of columns times coefficients.
struct Shape {
  /// Adds it to a series.
  std::function<void(const Eigen::VectorXd& coefficients, Eigen::VectorXd& to)> add;
  /// The cosine_transform() of each column over n samples, (n - 1) × columns, in closed form (sums
  /// of geometric series): it costs no Fourier transform.
  std::function<Eigen::MatrixXd(Eigen::Index n)> cosines;
};

/// t/rate, in s at a rate in Hz.
Shape ramp(double rate);
/// exp(-(t + after)/τ), τ > 0, both in samples.
Shape warm_up(double tau, Eigen::Index after);
/// 0 before sample `at`, 1 from it on.
Shape step(Eigen::Index at);
/// The cosine and sine of each multiple of a frequency in cycles per sample, side by side.
Shape waves(double frequency, int harmonics);

/// cos(πk(t + after + ½)/length) for k = 1 … count, a column each; `after` and `length` in samples.
/// From `length` on they stay as they are; the cosines are then not in closed form.
Shape half_waves(Eigen::Index length, int count, Eigen::Index after);

}  // namespace imunoise
