#include "study/analysis/noise_budget.h"

#include <algorithm>
#include <cmath>

#include "core/support/distributions.h"
#include "study/analysis/measure.h"

namespace imunoise::study {

v1::NoiseBudget noise_budget(const Model& noise, const std::vector<WaveletVariance>& measured,
                             const MomentCovariances& covariances,
                             const std::vector<std::vector<bool>>& tested, double confidence) {
  const WaveletVariance total = pooled(measured);
  const Eigen::ArrayXd m = total.scales.half_widths();
  const Eigen::ArrayXd nu = variance(noise, m);
  const double tail = 0.5 * (1.0 - confidence);
  v1::NoiseBudget out;
  for (std::size_t i = 0; i < total.scales.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    double weights = 0.0;
    double spread = 0.0;
    bool any_tested = false;
    for (std::size_t k = 0; k < measured.size(); ++k) {
      const auto& scales = measured[k].scales;
      const auto found = std::find(scales.begin(), scales.end(), total.scales[i]);
      if (found == scales.end()) continue;
      const auto own = found - scales.begin();
      const double weight = static_cast<double>(measured[k].samples) - 2.0 * m(at) + 1.0;
      weights += weight;
      spread += weight * weight * covariances[k](own, own);
      any_tested = any_tested || tested[k][static_cast<std::size_t>(own)];
    }
    spread /= weights * weights;
    const double edof = spread > 0.0 ? 2.0 * nu(at) * nu(at) / spread : 1.0;
    out.add_scales(2.0 * m(at));
    out.add_scales_s(2.0 * m(at) / total.rate.value);
    out.add_measured(total.variance(at));
    out.add_lower(total.variance(at) * edof / chi_square_quantile(1.0 - tail, edof));
    out.add_upper(total.variance(at) * edof / chi_square_quantile(tail, edof));
    out.add_model(nu(at));
    out.add_residual(spread > 0.0 ? (total.variance(at) - nu(at)) / std::sqrt(spread) : 0.0);
    out.add_tested(any_tested);
  }
  return out;
}

}  // namespace imunoise::study
