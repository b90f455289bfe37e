#include "core/array/array_moments.h"

#include <algorithm>

#include "core/wavelet/lag_sums.h"

namespace imunoise {
namespace {

// The distinct shapes behind a model, each with all the power that has it.
struct Shapes {
  explicit Shapes(const ArrayModel& model)
      : ramps(Eigen::MatrixXd::Zero(model.sensors, model.sensors)) {
    std::vector<Process> known;
    for (const Latent& latent : model.latents) {
      if (latent.power.isZero(0.0)) continue;
      const SumCovariance sum = sum_covariance(latent.term.process);
      ramps += sum.slope_squared * latent.power;
      if (sum.slope_squared != 0.0) continue;  // a ramp is not random
      const auto found = std::find(known.begin(), known.end(), latent.term.process);
      if (found == known.end()) {
        known.push_back(latent.term.process);
        sums.push_back(sum);
        powers.push_back(latent.power);
      } else {
        powers[static_cast<std::size_t>(found - known.begin())] += latent.power;
      }
    }
  }

  std::vector<SumCovariance> sums;
  std::vector<Eigen::MatrixXd> powers;
  Eigen::MatrixXd ramps;  // ω_a ω_b
};

}  // namespace

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

Eigen::MatrixXd array_moment_covariance(const ArrayModel& model, const Pairs& pairs,
                                        const Scales& scales, std::size_t samples) {
  const Shapes shapes(model);
  const LagSums sums(shapes.sums, scales, samples);
  const auto n = static_cast<Eigen::Index>(scales.size());
  const std::size_t count = shapes.sums.size();
  Eigen::MatrixXd out(n * static_cast<Eigen::Index>(pairs.size()),
                      n * static_cast<Eigen::Index>(pairs.size()));
  const auto fill = [&](std::size_t p, std::size_t q) {
    const auto [a, b] = pairs[p];
    const auto [c, d] = pairs[q];
    Eigen::MatrixXd weight(count, count);
    Eigen::VectorXd ramp(count);
    for (std::size_t t = 0; t < count; ++t) {
      const Eigen::MatrixXd& x = shapes.powers[t];
      for (std::size_t u = 0; u < count; ++u) {
        const Eigen::MatrixXd& y = shapes.powers[u];
        weight(static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(u)) =
            x(a, c) * y(b, d) + x(a, d) * y(b, c);
      }
      const Eigen::MatrixXd& w = shapes.ramps;
      ramp(static_cast<Eigen::Index>(t)) =
          w(a, c) * x(b, d) + w(a, d) * x(b, c) + w(b, c) * x(a, d) + w(b, d) * x(a, c);
    }
    for (std::size_t j = 0; j < scales.size(); ++j) {
      for (std::size_t k = 0; k < scales.size(); ++k) {
        const double means = 0.25 * static_cast<double>(scales[j]) * static_cast<double>(scales[k]);
        const double value =
            weight.cwiseProduct(sums.products(j, k)).sum() + means * ramp.dot(sums.plain(j, k));
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

}  // namespace imunoise
