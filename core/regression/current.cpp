#include "core/regression/current.h"

#include <algorithm>

#include "core/spectrum/cosine_transform.h"
#include "core/support/parallel.h"

namespace imunoise {

std::size_t Current::longest() const {
  const auto found =
      std::max_element(cosines.begin(), cosines.end(),
                       [](const auto& a, const auto& b) { return a.size() < b.size(); });
  return static_cast<std::size_t>(found - cosines.begin());
}

Current current_of(const Regression& regression, const JointFit& fit) {
  const std::size_t count = regression.subject().replicates();
  Current out{regression,
              fit,
              pooled(regression.residual(fit.effects, fit.model.noise)),
              std::vector<SharedVector>(count),
              std::vector<Eigen::ArrayXd>(count),
              std::vector<Eigen::VectorXd>(count)};
  for_each_index(count, [&](std::size_t k) {
    const Model& noise = fit.own_noise.empty() ? fit.model.noise : fit.own_noise[k];
    out.cosines[k] = regression.residual_cosines(fit.effects.value, k);
    out.spectrum[k] = spectrum_of_cosines(noise, out.cosines[k].size() + 1);
    out.weighted[k] = inverse_cosine_transform((out.cosines[k].array() / out.spectrum[k]).matrix());
  });
  return out;
}

}  // namespace imunoise
