#include "core/diagnosis/outliers.h"

#include <cmath>

#include "core/spectrum/cosine_transform.h"
#include "core/support/distributions.h"
#include "core/support/parallel.h"

namespace imunoise {

using Index = Eigen::Index;

Outliers find_outliers(const Current& current, double above) {
  const std::size_t count = current.weighted.size();
  Outliers out{std::vector<std::vector<Index>>(count), std::vector<std::vector<double>>(count),
               above};
  for (std::size_t k = 0; k < count; ++k) {
    const Eigen::VectorXd& u = current.weighted[k];
    const double information = (1.0 / current.spectrum[k]).mean();
    const double least = above * std::sqrt(information);
    for (Index t = 0; t < u.size(); ++t) {
      const double size = std::abs(u(t));
      if (size < least) continue;
      const bool peak = (t == 0 || size >= std::abs(u(t - 1))) &&
                        (t + 1 == u.size() || size > std::abs(u(t + 1)));
      if (!peak) continue;
      out.places[k].push_back(t);
      out.sizes[k].push_back(u(t) / information);
      out.gain_nats += 0.5 * size * size / information;
      ++out.count;
    }
  }
  return out;
}

double outlier_threshold(const Subject& subject) {
  double samples = 0.0;
  for (const SharedVector& x : subject.samples) samples += static_cast<double>(x.size());
  constexpr double kOnceIn = 20.0;
  return normal_quantile(1.0 - 0.5 / (kOnceIn * samples));
}

std::shared_ptr<const Subject> without(const Subject& subject, const Outliers& outliers) {
  auto out = std::make_shared<Subject>(subject);
  out->own_nats.resize(out->samples.size(), 0.0);
  for_each_index(out->samples.size(), [&](std::size_t k) {
    if (outliers.places[k].empty()) return;
    out->own_nats[k] +=
        0.5 * outliers.above * outliers.above * static_cast<double>(outliers.places[k].size());
    Eigen::VectorXd samples = out->samples[k];
    for (std::size_t i = 0; i < outliers.places[k].size(); ++i)
      samples(outliers.places[k][i]) -= outliers.sizes[k][i];
    samples.array() -= samples.mean();
    out->cosines[k] = cosine_transform(samples);
    out->samples[k] = std::move(samples);
  });
  return out;
}

}  // namespace imunoise
