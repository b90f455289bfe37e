#include "core/regression/free_ends.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/regression/current.h"
#include "core/spectrum/cosine_transform.h"
#include "core/support/linear_algebra.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr Index kMostEnds = 64;

// a(h) = 1/n Σ_k cos(πkh/n) / spectrum_k, h = 0 … n: the inverse of the noise's covariance has the
// entry a(s - t) + a(s + t + 1) at samples s and t.
Eigen::ArrayXd inverse_covariance(const Eigen::ArrayXd& spectrum) {
  const Index n = spectrum.size() + 1;
  const auto samples = static_cast<double>(n);
  const Eigen::ArrayXd k = Eigen::ArrayXd::LinSpaced(n - 1, 1.0, samples - 1.0);
  const Eigen::ArrayXd impulse =
      std::sqrt(2.0 / samples) * (k * (0.5 * std::numbers::pi / samples)).cos();
  const Eigen::VectorXd row = inverse_cosine_transform((impulse / spectrum).matrix());
  Eigen::ArrayXd out(n + 1);
  out(0) = (1.0 / spectrum).sum() / samples;
  for (Index t = 0; t < n; ++t) out(t + 1) = row(t) - out(t);
  return out;
}

// Measured samples s with what makes the rest likeliest in their place.
Eigen::VectorXd filled(const Current& current, std::size_t k, Index ends) {
  Eigen::VectorXd samples = current.subject().samples[k];
  const Index n = samples.size();
  const Eigen::ArrayXd a = inverse_covariance(current.spectrum[k]);
  const auto at = [&](Index h) { return a(h > n ? 2 * n - h : h); };
  const auto place = [&](Index i) { return i < ends ? i : n - 2 * ends + i; };
  Eigen::MatrixXd precision(2 * ends, 2 * ends);
  Eigen::VectorXd score(2 * ends);
  for (Index i = 0; i < 2 * ends; ++i) {
    const Index s = place(i);
    score(i) = current.weighted[k](s);
    for (Index j = 0; j < 2 * ends; ++j) {
      const Index t = place(j);
      precision(i, j) = at(std::abs(s - t)) + at(s + t + 1);
    }
  }
  const Eigen::VectorXd change = solve_symmetric(precision, score);
  if (!change.allFinite()) return samples;
  for (Index i = 0; i < 2 * ends; ++i) samples(place(i)) -= change(i);
  samples.array() -= samples.mean();
  return samples;
}

std::shared_ptr<const Subject> with_filled_ends(const Current& current, Index ends) {
  auto out = std::make_shared<Subject>(current.subject());
  const double price = static_cast<double>(std::max<Index>(0, ends - out->free_ends));
  out->free_ends = std::max(ends, out->free_ends);
  out->reshaped_nats.resize(out->replicates(), 0.0);
  for_each_index(out->replicates(), [&](std::size_t k) {
    if (out->length(k) < 16 * out->free_ends) return;
    Eigen::VectorXd samples = filled(current, k, out->free_ends);
    out->cosines[k] = cosine_transform(samples);
    out->samples[k] = std::move(samples);
    out->reshaped_nats[k] -= price;  // two ends, half a nat a sample
  });
  return out;
}

}  // namespace

Index free_ends(const Model& noise) { return std::min<Index>(most_taps(noise) / 2, kMostEnds); }

FittedModel beside_free_ends(FittedModel fitted) {
  constexpr int kTurns = 2;
  const Index ends = free_ends(fitted.fit.model.noise);
  for (int turn = 0; turn < kTurns && ends > 0; ++turn) {
    fitted.regression =
        fitted.regression.on(with_filled_ends(current_of(fitted.regression, fitted.fit), ends));
    fitted.fit = joint_fit(fitted.regression, fitted.fit.model.noise, {}, Begin::kNear,
                           fitted.fit.own_noise);
  }
  return fitted;
}

}  // namespace imunoise
