#include "core/wavelet/moment_covariance.h"

#include "core/wavelet/lag_sums.h"

namespace imunoise {

Eigen::MatrixXd moment_covariance(const SumCovariance& process, const Scales& scales,
                                  std::size_t samples) {
  const LagSums sums(std::span(&process, 1), scales, samples);
  const auto n = static_cast<Eigen::Index>(scales.size());
  Eigen::MatrixXd out(n, n);
  for (std::size_t j = 0; j < scales.size(); ++j) {
    for (std::size_t k = 0; k < scales.size(); ++k) {
      const double means = process.slope_squared * static_cast<double>(scales[j]) *
                           static_cast<double>(scales[k]) / 4.0;
      out(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(k)) =
          2.0 * sums.products(j, k)(0, 0) + 4.0 * means * sums.plain(j, k)(0);
    }
  }
  return out;
}

}  // namespace imunoise
