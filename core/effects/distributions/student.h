#pragma once

// Noise of Student's distribution, seen in how often innovations of each size occur.

#include <array>
#include <vector>

#include "core/support/linear_algebra.h"
#include "core/support/random.h"

namespace imunoise {

/// How many innovations have each absolute size, by its logarithm.
struct SizeCounts {
  static constexpr std::size_t kSizes = 1024;
  std::array<double, kSizes> count{};
  static std::size_t place(double size);
  static double size(std::size_t place);  ///< in its middle
};
SizeCounts count_sizes(const std::vector<Eigen::VectorXd>& innovations);

struct Student {
  double dof = 4.0;
  double scale = 1.0;
};
double log_density(const Student& student, double size);
double log_normal_density(double size);  ///< of variance 1

/// The scale of most likelihood.
Student student_of(const SizeCounts& sizes, double dof);
/// The distribution of most likelihood.
Student best_student(const SizeCounts& sizes);
/// Nats that it gains over a normal distribution of the best variance.
double gain_of(const SizeCounts& sizes, const Student& student);

/// The normal number as probable as one of Student's, over it.
class NormalFromStudent {
 public:
  explicit NormalFromStudent(const Student& student);
  double factor(double size) const { return factor_[SizeCounts::place(size)]; }
  /// How much the normal number changes with Student's, on average over numbers of these sizes.
  double slope(const SizeCounts& sizes) const;

 private:
  std::array<double, SizeCounts::kSizes> factor_{};
};

/// Variance 1.
double student_number(double dof, RandomStream& random);

}  // namespace imunoise
