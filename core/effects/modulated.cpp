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

const std::vector<SharedVector>& modulated_course(const EffectTerm& term, const Subject& subject) {
  return subject.find(term.witness)->samples;
}

std::string modulated_unit(const EffectTerm& term, const Subject& subject) {
  const std::string below = unit_of(*subject.find(term.witness));
  return below == "1" ? below : "1/" + below;
}

void simulate_modulated(const EffectTerm& term, const SimulatedReplicate& at,
                        Eigen::VectorXd& samples) {
  const SharedVector& course = at.beside.find(term.witness)->samples[at.replicate];
  samples.array() *= (0.5 * term[kModulatedSlope] * course.array()).exp();
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
    const double gain = modulation_by(witnesses[w].samples, white).log_likelihood;
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
      .numbers = modulated_numbers,
  };
  return kModulated;
}

}  // namespace imunoise::effects
