// heavy_tails: large deviations are more frequent than in normal noise.

#include <algorithm>
#include <cmath>

#include "core/effect/columns.h"
#include "core/effect/converter_steps.h"
#include "core/effects/distributions/power_spell.h"
#include "core/effects/distributions/tails.h"
#include "core/effects/reshaped_noise.h"
#include "core/search/search_view.h"

namespace imunoise::effects {

const Effect& heavy_tails();

namespace {

enum HeavyTailsParameter : std::size_t { kHeavyTailsDof, kHeavyTailsSize };

double level_of(const Eigen::VectorXd& white) {
  return std::sqrt(white.squaredNorm() / static_cast<double>(white.size()));
}

// Sizes over the level of their replicate: several levels together have tails that none of them
// has.
SizeCounts levelled_sizes(std::vector<Eigen::VectorXd> white) {
  for (Eigen::VectorXd& one : white) one /= level_of(one);
  return count_sizes(white);
}

std::shared_ptr<const Subject> of_normal_tails(const EffectTerm& term, const Current& current) {
  const SizeCounts sizes = levelled_sizes(innovations(current.regression, current.fit).white);
  const Student student = student_of(sizes, term[kHeavyTailsDof]);
  const NormalFromStudent table(student);
  const double slope = table.slope(sizes);
  return reshaped(current, [&](const Eigen::VectorXd& white, std::size_t) {
    Reshaping out{Eigen::ArrayXd(white.size()), 0.0, slope};
    const double level = level_of(white);
    for (Eigen::Index t = 0; t < white.size(); ++t) {
      const double size = std::abs(white(t)) / level;
      out.factor(t) = table.factor(size);
      *out.nats += log_density(student, size) - log_normal_density(size);
    }
    return out;
  });
}

std::string_view heavy_tails_fault(const EffectTerm& term) {
  return term[kHeavyTailsDof] > 2.0 ? "" : "dof must lie above 2: below, the power is infinite";
}

void simulate_heavy_tails(const EffectTerm& term, const SimulatedReplicate& at,
                          Eigen::VectorXd& samples) {
  const double dof = term[kHeavyTailsDof];
  for (double& x : samples) x += term[kHeavyTailsSize] * student_number(dof, at.random);
}

// One distribution is enough, and rounding has its own.
bool may_have_tails(const Current& current) {
  const std::vector<EffectTerm>& effects = current.regression.effects();
  return std::none_of(effects.begin(), effects.end(),
                      [](const EffectTerm& one) { return one.effect == &heavy_tails(); }) &&
         !converter_steps(current.subject()).is_coarse();
}

Suggestions search_heavy_tails(const SearchView& view) {
  const SizeCounts sizes = levelled_sizes(view.unmodulated().white);
  const Student best = best_student(sizes);
  const double gain = may_have_tails(view.current()) ? std::max(0.0, gain_of(sizes, best)) : 0.0;
  return {{.cause = "heavy_tails",
           .added = EffectTerm(heavy_tails(), "", {{"dof", best.dof}}),
           .score_nats = gain,
           .power = true}};
}

// What counts is what is left of the tails beside noise of another power for a while.
void review_heavy_tails(const Current& current, TriedTerm& tried) {
  const Innovations all = innovations(current.regression, current.fit);
  const SizeCounts sizes = levelled_sizes(all.white);
  const SizeCounts beside = levelled_sizes(beside_spells(all.white));
  const double most = std::min(tried.likelihood_gain, tried.suggestion.score_nats);
  tried.likelihood_gain =
      std::clamp(gain_of(beside, best_student(beside)), 0.0, std::max(0.0, most));
  if (!compare_tails(sizes).rules_out_mixture()) tried.could_be.push_back("outliers");
}

// All innovations have such tails.
std::vector<ReportedNumber> heavy_tails_numbers(const FittedEffect& effect) {
  return {{"size", innovation_deviation(effect.model.fit.model.noise),
           unit_of(effect.term(), effect.subject())}};
}

}  // namespace

const Effect& heavy_tails() {
  static const Effect kHeavyTails{
      .name = "heavy_tails",
      .title = "heavy tails",
      .meaning =
          "The noise has Student's distribution: large deviations are more frequent than "
          "in normal noise.",
      .parameters = {{.name = "dof",
                      .meaning = "degrees of freedom of Student's distribution, above 2",
                      .unit = "1",
                      .required = true,
                      .reported = "dof",
                      .rounding = Rounding::kFourDigits},
                     {.name = "size",
                      .meaning = "standard deviation of the noise that has them",
                      .reported = "size",
                      .truth = true}},
      .causes = {{.id = "heavy_tails",
                  .title = "heavy tails",
                  .physics = "Large deviations of all sizes are more frequent than in normal "
                             "noise: the noise of single events, or of a power that changes from "
                             "sample to sample.",
                  .record_next = "the raw samples before any filter, at the highest rate",
                  .looks_like = {"outliers", "variance_wander"},
                  .family = "heavy_tails"}},
      .fault = heavy_tails_fault,
      .cleaned = of_normal_tails,
      .simulate = simulate_heavy_tails,
      .search = search_heavy_tails,
      .review = review_heavy_tails,
      .numbers = heavy_tails_numbers,
  };
  return kHeavyTails;
}

}  // namespace imunoise::effects
