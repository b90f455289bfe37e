#include "core/diagnosis/heldout.h"

#include <algorithm>
#include <numeric>

#include "core/effects/own_powers.h"
#include "core/spectrum/cosine_transform.h"
#include "core/support/parallel.h"
#include "core/wavelet/scales.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr std::size_t kBlocks = 4;    // of a single replicate, which stand in for replicates
constexpr Index kShortestCut = 4096;  // samples

Scales scales_of(const Eigen::VectorXd& samples) {
  return Scales::for_samples(static_cast<std::size_t>(samples.size()));
}

// Of one replicate.
double log_likelihood_of(const Regression& one, const Eigen::VectorXd& coefficients,
                         const Model& noise) {
  const std::vector<double>& nats = one.subject().reshaped_nats;
  const double reshaped = nats.empty() ? 0.0 : nats[one.replicates().front()];
  return reshaped - whittle_objective(noise, one.residual(coefficients));
}

// What the modulated effects of a fit to others gain on one replicate, whose coefficients are
// given and whose noise is its own where an effect makes it so.
double modulation_gain(const Regression& one, const JointFit& fit,
                       const Eigen::VectorXd& coefficients) {
  if (fit.modulation.empty()) return 0.0;
  double out = 0.0;
  JointFit here{.model = fit.model, .effects = {coefficients, {}}};
  for (const EffectTerm& term : one.effects()) {
    if (term.effect->own_noise != nullptr) term.effect->own_noise(term, one, here);
  }
  Innovations white = innovations(one, here);
  const std::vector<VarianceCourse> courses = variance_courses(one);
  for (std::size_t m = 0; m < courses.size(); ++m) {
    out += predicted_gain(fit.modulation[m], courses[m], white);
    take_out(fit.modulation[m], courses[m], white);
  }
  return out;
}

// What noise of its own gains on the quarters of a replicate, each by a fit to the other three.
// The search begins at what was fitted to all four, `own`: from the noise of other replicates it
// can end in a lower maximum.
double own_noise_gain(const EffectTerm& term, const Model& noise, const Model& own,
                      const Eigen::VectorXd& left, const Subject& subject) {
  const std::size_t length = quick_length(static_cast<std::size_t>(left.size()) / kBlocks);
  std::vector<BandedPower> quarters;
  for (std::size_t b = 0; b < kBlocks; ++b) {
    const std::span<const double> samples(left.data() + b * length, length);
    quarters.push_back(banded_power(Signal(samples, subject.rate, subject.quantity)));
  }
  double out = 0.0;
  for (std::size_t b = 0; b < kBlocks; ++b) {
    std::vector<BandedPower> others = quarters;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(b));
    const std::span<const BandedPower> held(&quarters[b], 1);
    out += whittle_objective(noise, held) -
           whittle_objective(effects::own_noise_of(term, noise, own, pooled(others)).model, held);
  }
  return out;
}

// Replicates, or blocks of a single one that is long enough; with powers of its own, blocks of
// each.
bool can_hold_out(const FittedModel& fitted) {
  const Subject& subject = fitted.regression.subject();
  if (subject.replicates() > 1 && fitted.fit.own_noise.empty()) return true;
  for (std::size_t k = 0; k < subject.replicates(); ++k) {
    if (subject.length(k) < kShortestCut) return false;
  }
  return true;
}

}  // namespace

double HeldOut::total_likelihood() const { return std::accumulate(nats.begin(), nats.end(), 0.0); }

std::optional<HeldOut> held_out(const FittedModel& fitted) {
  if (!can_hold_out(fitted)) return std::nullopt;
  const Subject& subject = fitted.regression.subject();
  const bool single = subject.replicates() == 1;
  const auto& effects = fitted.regression.effects();
  const auto own_noise = std::find_if(effects.begin(), effects.end(), [](const EffectTerm& term) {
    return term.effect->own_noise != nullptr;
  });
  const Regression all = single ? fitted.regression.in_blocks(kBlocks) : fitted.regression;
  // The others' own noise says nothing about this one, unless to weigh what modulates all.
  const bool needed = own_noise == effects.end() || !variance_courses(all).empty();
  const auto place = static_cast<std::size_t>(own_noise - effects.begin());
  const Regression shared = needed ? all : all.without(place);
  const std::size_t count = all.subject().replicates();
  HeldOut out{std::vector<double>(count), std::vector<Eigen::Index>(count), 0};
  for (const SharedVector& one : subject.samples)
    out.scores += static_cast<Eigen::Index>(scales_of(one).size());
  for_each_index(count, [&](std::size_t k) {
    std::vector<std::size_t> others;
    for (std::size_t i = 0; i < count; ++i) {
      if (i != k) others.push_back(i);
    }
    const Regression rest = shared.of(others);
    const JointFit fit = joint_fit(rest, fitted.fit.model.noise, {}, Begin::kNear);
    const Model& noise = fit.model.noise;
    const Regression one = all.of({k});
    out.samples[k] = all.subject().length(k);
    const Eigen::VectorXd at = one.under(noise, fit.effects.value, rest).value;
    // What the replicate itself gave: a coefficient costs a nat.
    const auto& own_nats = all.subject().own_nats;
    double own = own_nats.empty() ? 0.0 : own_nats[k];
    const auto& names = all.coefficients();
    for (std::size_t i = 0; i < names.size(); ++i) {
      const bool shared_by_all = names[i].replicate == CoefficientName::kAll;
      const bool here = names[i].replicate == k;
      own += here || (shared_by_all && !rest.shows(static_cast<Index>(i))) ? 1.0 : 0.0;
    }
    out.nats[k] = log_likelihood_of(one, at, noise) - own + modulation_gain(one, fit, at);
    if (!single && own_noise != effects.end())
      out.nats[k] += own_noise_gain(*own_noise, noise, fitted.fit.own_noise[k],
                                    all.residual_samples(at, k), subject);
  });
  return out;
}

}  // namespace imunoise
