#include "core/array/array_moments.h"

#include <algorithm>
#include <cassert>

namespace imunoise {

Pairs all_pairs(Eigen::Index sensors) {
  Pairs out;
  for (Eigen::Index a = 0; a < sensors; ++a) {
    for (Eigen::Index b = a; b < sensors; ++b) out.push_back({a, b});
  }
  return out;
}

Pairs own_pairs(Eigen::Index sensors) {
  Pairs out;
  for (Eigen::Index a = 0; a < sensors; ++a) out.push_back({a, a});
  return out;
}

Eigen::VectorXd moments_of(const std::vector<Eigen::MatrixXd>& covariance, const Pairs& pairs) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(covariance.size() * pairs.size()));
  Eigen::Index at = 0;
  for (const Pair& pair : pairs) {
    for (const Eigen::MatrixXd& scale : covariance) out(at++) = scale(pair.a, pair.b);
  }
  return out;
}

ArrayMomentCovariance::Shapes::Shapes(const ArrayModel& model) {
  std::vector<Process> known;
  for (const Latent& latent : model.latents) {
    const Process& process = latent.term.process;
    const auto found = std::find(known.begin(), known.end(), process);
    of_latent.push_back(static_cast<std::size_t>(found - known.begin()));
    if (found != known.end()) continue;
    known.push_back(process);
    sums.push_back(sum_covariance(process));
  }
}

ArrayMomentCovariance::ArrayMomentCovariance(const ArrayModel& shapes, const Scales& scales,
                                             std::size_t samples)
    : shapes_(shapes), scales_(scales), sums_(shapes_.sums, scales, samples) {}

Eigen::MatrixXd ArrayMomentCovariance::operator()(const ArrayModel& model,
                                                  const Pairs& pairs) const {
  assert(model.latents.size() == shapes_.of_latent.size());
  const std::size_t count = shapes_.sums.size();
  Eigen::MatrixXd ramps = Eigen::MatrixXd::Zero(model.sensors, model.sensors);  // ω_a ω_b
  std::vector<Eigen::MatrixXd> powers(count, ramps);
  for (std::size_t t = 0; t < model.latents.size(); ++t) {
    const std::size_t shape = shapes_.of_latent[t];
    ramps += shapes_.sums[shape].slope_squared * model.latents[t].power;
    powers[shape] += model.latents[t].power;
  }
  const auto n = static_cast<Eigen::Index>(scales_.size());
  Eigen::MatrixXd out(n * static_cast<Eigen::Index>(pairs.size()),
                      n * static_cast<Eigen::Index>(pairs.size()));
  const auto fill = [&](std::size_t p, std::size_t q) {
    const auto [a, b] = pairs[p];
    const auto [c, d] = pairs[q];
    Eigen::MatrixXd weight(count, count);
    Eigen::VectorXd ramp(count);
    for (std::size_t t = 0; t < count; ++t) {
      const Eigen::MatrixXd& x = powers[t];
      for (std::size_t u = 0; u < count; ++u) {
        const Eigen::MatrixXd& y = powers[u];
        weight(static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(u)) =
            x(a, c) * y(b, d) + x(a, d) * y(b, c);
      }
      const Eigen::MatrixXd& w = ramps;
      ramp(static_cast<Eigen::Index>(t)) =
          w(a, c) * x(b, d) + w(a, d) * x(b, c) + w(b, c) * x(a, d) + w(b, d) * x(a, c);
    }
    for (std::size_t j = 0; j < scales_.size(); ++j) {
      for (std::size_t k = 0; k < scales_.size(); ++k) {
        const double means =
            0.25 * static_cast<double>(scales_[j]) * static_cast<double>(scales_[k]);
        const double value =
            weight.cwiseProduct(sums_.products(j, k)).sum() + means * ramp.dot(sums_.plain(j, k));
        const Eigen::Index row = static_cast<Eigen::Index>(p) * n + static_cast<Eigen::Index>(j);
        const Eigen::Index column = static_cast<Eigen::Index>(q) * n + static_cast<Eigen::Index>(k);
        out(row, column) = value;
        out(column, row) = value;
      }
    }
  };
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    for (std::size_t q = 0; q <= p; ++q) fill(p, q);
  }
  return out;
}

Eigen::MatrixXd array_moment_covariance(const ArrayModel& model, const Pairs& pairs,
                                        const Scales& scales, std::size_t samples) {
  return ArrayMomentCovariance(model, scales, samples)(model, pairs);
}

}  // namespace imunoise
