#include "core/effects/reshaped_noise.h"

#include "core/spectrum/cosine_transform.h"
#include "core/support/parallel.h"

namespace imunoise {

std::shared_ptr<Subject> reshaped(
    const Current& current,
    const std::function<Reshaping(const Eigen::VectorXd& white, std::size_t replicate)>& reshape) {
  auto out = std::make_shared<Subject>(current.subject());
  const std::size_t count = out->replicates();
  out->reshaped_nats.resize(count, 0.0);
  for_each_index(count, [&](std::size_t k) {
    const Eigen::ArrayXd deviation = current.spectrum[k].sqrt();
    const Eigen::VectorXd white =
        inverse_cosine_transform((current.cosines[k].array() / deviation).matrix());
    const Reshaping how = reshape(white, k);
    const Eigen::VectorXd even = (white.array() * how.factor).matrix();
    // The samples' own likelihood rises by what the squares lose; the distribution's counts.
    out->reshaped_nats[k] += how.nats - 0.5 * (white.squaredNorm() - even.squaredNorm());
    const Eigen::ArrayXd left = cosine_transform(even).array() * deviation;
    Eigen::VectorXd cosines =
        (out->cosines[k].array() + left - current.cosines[k].array()).matrix();
    out->samples[k] = inverse_cosine_transform(cosines);
    out->cosines[k] = std::move(cosines);
  });
  return out;
}

}  // namespace imunoise
