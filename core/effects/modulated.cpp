// modulated: the noise's power follows another channel.

#include <algorithm>
#include <cmath>

#include "core/effect/columns.h"
#include "core/search/search_view.h"
#include "core/support/parallel.h"

namespace imunoise::effects {

const Effect& modulated();

namespace {

enum ModulatedParameter : std::size_t { kModulatedSlope };

VarianceCourse modulated_course(const EffectTerm& term, const Subject& subject) {
  const Witness& channel = *subject.find(term.witness);
  return {channel.samples, channel.levels};
}

std::string modulated_unit(const EffectTerm& term, const Subject& subject) {
  return per("1", unit_of(*subject.find(term.witness)));
}

void simulate_modulated(const EffectTerm& term, const SimulatedReplicate& at,
                        Eigen::VectorXd& samples) {
  // The noise has its own power at the mean of the first replicate.
  const VarianceCourse course = modulated_course(term, at.beside);
  const double level = course.level(at.replicate) - course.level(0);
  samples.array() *= (0.5 * term[kModulatedSlope] * (course[at.replicate].array() + level)).exp();
}

// Squares of neighbours are not independent where the power wanders by itself: what the course
// gains beside that counts.
double inflation_of(double gain, const PowerView::Explained& explained) {
  constexpr double kLeast = 1e-3;  // nats
  if (explained.steady || !(explained.gain < gain)) return 1.0;
  return gain / std::max(kLeast, explained.gain);
}

Suggestions search_modulated(const SearchView& view) {
  const std::vector<Witness>& witnesses = view.subject().witnesses;
  if (witnesses.empty()) return {};
  const Innovations& white = view.innovations();
  const std::vector<PowerView::Explained>& explained = view.power_explained();
  std::vector<std::optional<Suggestion>> each(witnesses.size());
  for_each_index(each.size(), [&](std::size_t w) {
    const double gain = modulation_by({witnesses[w].samples}, white).log_likelihood;
    const double chance = explained.empty() ? 1.0 : inflation_of(gain, explained[w]);
    each[w] = Suggestion{.cause = "modulated_variance",
                         .added = EffectTerm(modulated(), witnesses[w].name),
                         .score_nats = gain / chance,
                         .inflation = chance};
  });
  Suggestions out;
  for (auto& one : each) out.push_back(std::move(*one));
  return out;
}

// Differences between replicates are few, and another cause may make them: they are part of the
// fit, and no evidence.
void review_modulated(const Current&, TriedTerm& tried) {
  tried.against_wander = true;
  const Suggestion& found = tried.suggestion;
  constexpr double kSurely = 12.0;  // nats
  if (std::min(tried.likelihood_gain, found.score_nats) > kSurely)
    tried.fitted = found_anew(std::move(tried.fitted));
  tried.likelihood_gain = std::min(tried.likelihood_gain, found.score_nats * found.inflation);
}

std::vector<ReportedNumber> modulated_numbers(const FittedEffect& effect) {
  // The fit has one modulation a term, in their order.
  std::size_t before = 0;
  for (std::size_t e = 0; e < effect.number; ++e) {
    if (effect.model.regression.effects()[e].effect->variance_course != nullptr) ++before;
  }
  const Modulation& found = effect.model.fit.modulation[before];
  return {with_error({"log_variance_slope", found.slope / found.deviation,
                      modulated_unit(effect.term(), effect.subject())},
                     found.error / found.deviation)};
}

}  // namespace

const Effect& modulated() {
  static const Effect kModulated{
      .name = "modulated",
      .title = "noise that follows a channel",
      .meaning = "The logarithm of the noise's variance is proportional to a witness.",
      .witness = true,
      .parameters = {{.name = "log_variance_slope",
                      .meaning = "change of the logarithm of the variance per unit of the witness",
                      .lower = -1e15,
                      .reported = "log_variance_slope",
                      .truth = true}},
      .coefficient = "log_variance_slope",
      .causes = {{.id = "modulated_variance",
                  .title = "noise that follows another channel",
                  .physics = "The noise grows with temperature, supply or motion.",
                  .record_next = "plateaus of that channel, each held for an hour",
                  .looks_like = {"outliers", "replicate_change"},
                  .family = "modulated_variance"}},
      .unit = modulated_unit,
      .variance_course = modulated_course,
      .simulate = simulate_modulated,
      .search = search_modulated,
      .review = review_modulated,
      .numbers = modulated_numbers,
  };
  return kModulated;
}

}  // namespace imunoise::effects
