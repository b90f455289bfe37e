#include "core/effects/reshaped_noise.h"

#include <cmath>
#include <vector>

#include "core/spectrum/cosine_transform.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

// Of innovations.
struct Squares {
  double before = 0.0;
  double after = 0.0;
};

}  // namespace

std::shared_ptr<Subject> reshaped(
    const Current& current,
    const std::function<Reshaping(const Eigen::VectorXd& white, std::size_t replicate)>& reshape) {
  auto out = std::make_shared<Subject>(current.subject());
  const std::size_t count = out->replicates();
  out->reshaped_nats.resize(count, 0.0);
  std::vector<Squares> squares(count);
  for_each_index(count, [&](std::size_t k) {
    const Eigen::ArrayXd deviation = current.spectrum[k].sqrt();
    const Eigen::VectorXd white =
        inverse_cosine_transform((current.cosines[k].array() / deviation).matrix());
    const Reshaping how = reshape(white, k);
    const Eigen::VectorXd even = (white.array() * how.factor).matrix();
    squares[k] = {white.squaredNorm(), even.squaredNorm()};
    out->reshaped_nats[k] += how.nats;
    const Eigen::ArrayXd left = cosine_transform(even).array() * deviation;
    Eigen::VectorXd cosines =
        (out->cosines[k].array() + left - current.cosines[k].array()).matrix();
    out->samples[k] = inverse_cosine_transform(cosines);
    out->cosines[k] = std::move(cosines);
  });
  // The samples as normal numbers, whose level a fit finds anew, become more likely by so much;
  // what the distribution gains counts instead.
  Squares all;
  for (const Squares& one : squares) {
    all.before += one.before;
    all.after += one.after;
  }
  if (!(all.after > 0.0)) return out;
  const double level = all.after / all.before;
  for (std::size_t k = 0; k < count; ++k) {
    const auto n = static_cast<double>(out->length(k));
    out->reshaped_nats[k] +=
        0.5 * (n * std::log(level) + squares[k].after / level - squares[k].before);
  }
  return out;
}

}  // namespace imunoise
