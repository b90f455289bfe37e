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

// Standard errors by which an excess kurtosis is further from 0 than one that was.
double further_from_normal(double excess, const Tails& was) {
  return (std::abs(excess) - std::abs(was.excess)) / std::sqrt(24.0 / was.samples);
}

// What effects are multiplied by. Where the power hardly changes, one number loses hardly any
// information, and columns of one octave stay within it.
Eigen::VectorXd of_effects(const Reshaping& how) {
  constexpr double kHardly = 0.01;  // of the information
  const double mean = how.factor.mean();
  const bool steady = how.factor.square().mean() < (1.0 + kHardly) * mean * mean;
  if (how.slope || steady) return Eigen::VectorXd::Constant(1, how.slope.value_or(mean));
  return how.factor;
}

}  // namespace

Tails tails_of(const Innovations& innovations) {
  Tails out;
  for (const Eigen::VectorXd& white : innovations.white) {
    const auto n = static_cast<double>(white.size());
    const double level = white.squaredNorm() / n;
    out.excess += white.array().square().square().sum() / (level * level);
    out.samples += n;
  }
  out.excess = out.excess / out.samples - 3.0;
  return out;
}

bool worsens_tails(const Current& before, const FittedModel& after) {
  constexpr double kSurely = 4.0;  // standard errors
  const Tails was = tails_of(innovations(before.regression, before.fit));
  const Tails is = tails_of(innovations(after.regression, after.fit));
  return further_from_normal(is.excess, was) > kSurely;
}

bool will_worsen_tails(const Tails& before, double kurtosis_ratio) {
  constexpr double kSurely = 8.0;  // standard errors: the fit may find something smaller
  return further_from_normal((3.0 + before.excess) / kurtosis_ratio - 3.0, before) > kSurely;
}

std::optional<PowerMemory> memory_of_power(const Innovations& all) {
  constexpr double kNats = 3.0;  // rarely so many by chance
  const Tails tails = tails_of(all);
  std::optional<PowerMemory> out;
  for (const PowerMemory& one : power_memory(all)) {
    const bool more = one.nats > (out ? out->nats : kNats);
    if (more && !will_worsen_tails(tails, 1.0 + one.variance)) out = one;
  }
  return out;
}

std::shared_ptr<Subject> reshaped(
    const Current& current,
    const std::function<Reshaping(const Eigen::VectorXd& white, std::size_t replicate)>& reshape) {
  auto out = std::make_shared<Subject>(current.subject());
  const std::size_t count = out->replicates();
  out->reshaped_nats.resize(count, 0.0);
  std::vector<std::optional<Squares>> squares(count);  // where the distribution says what it gains
  const std::vector<VarianceCourse> courses = variance_courses(current.regression);
  auto evening = std::make_shared<Evening>();
  evening->noise = current.fit.own_noise;
  if (evening->noise.empty()) evening->noise = {current.fit.model.noise};
  evening->factor.resize(count);
  for_each_index(count, [&](std::size_t k) {
    const Eigen::ArrayXd deviation = current.spectrum[k].sqrt();
    const Eigen::VectorXd white =
        inverse_cosine_transform((current.cosines[k].array() / deviation).matrix());
    Eigen::VectorXd steady = white;
    for (std::size_t m = 0; m < courses.size(); ++m)
      take_out(current.fit.modulation[m], courses[m], k, steady);
    const Reshaping how = reshape(steady, k);
    if ((how.factor == 1.0).all()) return;
    if (how.nats)
      squares[k] = {steady.squaredNorm(), (steady.array() * how.factor).matrix().squaredNorm()};
    out->reshaped_nats[k] += how.nats.value_or(how.factor.log().sum());
    evening->factor[k] = of_effects(how);
    Eigen::VectorXd cosines = cosine_transform((white.array() * how.factor).matrix());
    cosines.array() *= deviation;
    if (!current.regression.coefficients().empty())
      cosines += made_even(*evening, k, out->cosines[k] - current.cosines[k]);
    out->samples[k] = inverse_cosine_transform(cosines);
    out->cosines[k] = std::move(cosines);
  });
  out->evenings.push_back(std::move(evening));
  // The samples as normal numbers, whose level a fit finds anew, become more likely by so much;
  // what the distribution gains counts instead.
  Squares all;
  for (const auto& one : squares) {
    all.before += one ? one->before : 0.0;
    all.after += one ? one->after : 0.0;
  }
  if (!(all.after > 0.0)) return out;
  const double level = all.after / all.before;
  for (std::size_t k = 0; k < count; ++k) {
    if (!squares[k]) continue;
    const auto n = static_cast<double>(out->length(k));
    out->reshaped_nats[k] +=
        0.5 * (n * std::log(level) + squares[k]->after / level - squares[k]->before);
  }
  return out;
}

}  // namespace imunoise
