#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/diagnosis/scan.h"
#include "core/spectrum/fourier.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

// What a step before each sample would gain in one replicate.
struct StepScores {
  Eigen::ArrayXd gain;         // nats, for a step before sample t
  Eigen::ArrayXd information;  // 1/variance of its height
  double path = 0.0;
};

StepScores step_scores(const Eigen::VectorXd& weighted, const Eigen::ArrayXd& spectrum) {
  const Index n = weighted.size();
  // The transform of a step at t0 is √(2/n) sin(πk t0/n) / (2 sin(πk/2n)): its information
  // (1/n) Σ w_k (1 - cos(2πk t0/n)) is a Fourier transform of w_k = 1/(4 sin²(πk/2n) S_k).
  std::vector<double> weight(static_cast<std::size_t>(n), 0.0);
  double total = 0.0;
  double turning = 0.0;
  for (Index k = 1; k < n; ++k) {
    const double s =
        2.0 * std::sin(std::numbers::pi * static_cast<double>(k) / (2.0 * static_cast<double>(n)));
    const double w = 1.0 / (s * s * spectrum(k - 1));
    const double speed = std::numbers::pi * static_cast<double>(k) / static_cast<double>(n);
    weight[static_cast<std::size_t>(k)] = w;
    total += w;
    turning += w * speed * speed;
  }
  const std::vector<std::complex<double>> wave = half_spectrum(weight);
  StepScores out{Eigen::ArrayXd::Zero(n), Eigen::ArrayXd::Zero(n),
                 static_cast<double>(n) * std::sqrt(turning / total)};
  double sum = 0.0;
  for (Index t = n - 1; t >= 1; --t) {
    sum += weighted(t);
    out.information(t) = (total - wave[static_cast<std::size_t>(std::min(t, n - t))].real()) /
                         static_cast<double>(n);
    if (out.information(t) > 0.0) out.gain(t) = 0.5 * sum * sum / out.information(t);
  }
  return out;
}

}  // namespace

Suggestions scan_steps(const Current& current) {
  const Subject& subject = current.subject();
  std::vector<StepScores> each(subject.replicates());
  for_each_index(each.size(), [&](std::size_t k) {
    each[k] = step_scores(current.weighted[k], current.spectrum[k]);
  });
  Suggestion best{.effect = "step", .added = EffectTerm{.kind = EffectKind::kStep}};
  for (std::size_t k = 0; k < each.size(); ++k) {
    best.search.path += each[k].path;
    Index at = 0;
    const double gain = each[k].gain.maxCoeff(&at);
    if (!(gain > best.score_nats)) continue;
    best.score_nats = gain;
    best.information = each[k].information(at);
    best.added = EffectTerm{.kind = EffectKind::kStep,
                            .replicate = static_cast<double>(k + 1),
                            .time = static_cast<double>(at) / subject.rate.value};
  }
  if (!(best.score_nats > 0.0)) return {};
  return {best};
}

}  // namespace imunoise
