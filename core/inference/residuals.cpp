#include "core/inference/residuals.h"

namespace imunoise {

void fill_residuals(Fit& fit, std::span<const WaveletVariance> replicates,
                    const PerReplicate<NormalScores>& scores) {
  fit.residuals.clear();
  fit.tested.clear();
  for (std::size_t k = 0; k < replicates.size(); ++k) {
    const Eigen::ArrayXd nu = variance(fit.estimate.model, replicates[k].scales.half_widths());
    fit.residuals.emplace_back((replicates[k].variance - nu) /
                               fit.covariances[k].diagonal().array().sqrt());
    fit.tested.push_back(scores[k].used());
  }
}

}  // namespace imunoise
