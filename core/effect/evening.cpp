#include "core/effect/evening.h"

#include <algorithm>

#include "core/spectrum/bands.h"
#include "core/spectrum/cosine_transform.h"

namespace imunoise {

using Index = Eigen::Index;

bool Evening::weights_samples() const {
  return std::any_of(factor.begin(), factor.end(),
                     [](const SharedVector& one) { return one.size() > 1; });
}

Eigen::ArrayXd spectrum_of_cosines(const Model& noise, Index n) {
  if (most_taps(noise) > 0) {  // zeros are narrower than bands
    const auto last = static_cast<double>(n - 1);
    const Eigen::ArrayXd k = Eigen::ArrayXd::LinSpaced(n - 1, 1.0, last);
    return spectrum(noise, Frequencies(0.5 / static_cast<double>(n) * k));
  }
  const Bands bands(n);
  const Eigen::ArrayXd level = spectrum(noise, bands.frequency);
  Eigen::ArrayXd out(n - 1);
  for (Index b = 0; b < bands.size(); ++b) {
    const Index begin = bands.edges[static_cast<std::size_t>(b)];
    out.segment(begin, bands.edges[static_cast<std::size_t>(b) + 1] - begin).setConstant(level(b));
  }
  return out;
}

Eigen::VectorXd made_even(const Evening& how, std::size_t replicate, const VectorRef& cosines) {
  const SharedVector& factor = how.factor[replicate];
  if (factor.size() == 0) return cosines;
  if (factor.size() == 1) return factor(0) * cosines;
  const Eigen::ArrayXd deviation =
      spectrum_of_cosines(how.noise_of(replicate), cosines.size() + 1).sqrt();
  Eigen::VectorXd samples = inverse_cosine_transform((cosines.array() / deviation).matrix());
  samples.array() *= factor.array();
  Eigen::VectorXd out = cosine_transform(samples);
  out.array() *= deviation;
  return out;
}

}  // namespace imunoise
