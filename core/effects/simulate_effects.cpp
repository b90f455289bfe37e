#include "core/effects/simulate_effects.h"

#include <fmt/format.h>

#include "core/effect/columns.h"

namespace imunoise {
namespace {

// Paths of random streams: noise takes (replicate, term).
constexpr std::uint32_t kEffectStreams = 0xeffec7;

}  // namespace

Result<void> check_simulation(const std::vector<EffectTerm>& terms, const Subject& beside) {
  for (const EffectTerm& term : terms) {
    const Effect& effect = *term.effect;
    for (std::size_t i = 0; i < term.values.size(); ++i) {
      const EffectParameter& about = effect.parameters[i];
      // A size whose absence has a meaning, such as a phase that is drawn, may be left out.
      if (about.truth && about.absent == 0.0 && !term.given(i))
        return unfit(term, fmt::format("a simulation needs {}=… ({})", about.name, about.meaning));
    }
    if (effect.witness && beside.find(term.witness) == nullptr)
      return unfit(term,
                   fmt::format("a simulation needs the samples of {0}; give imunoise simulate "
                               "--witness \"{0}: RW(gamma2=1e-6)\" or --witness {0}=FILE",
                               term.witness));
    if (effect.check == nullptr) continue;
    if (auto fits = effect.check(term, beside); !fits) return fits;
  }
  return {};
}

void simulate_effects(const std::vector<EffectTerm>& terms, const Subject& beside,
                      std::size_t replicate, std::uint64_t seed, Eigen::VectorXd& samples) {
  for (const bool noise : {true, false}) {
    for (std::size_t e = 0; e < terms.size(); ++e) {
      const Effect& effect = *terms[e].effect;
      if (changes_noise(effect) != noise) continue;
      RandomStream random(seed, {static_cast<std::uint32_t>(replicate), kEffectStreams,
                                 static_cast<std::uint32_t>(e)});
      effect.simulate(terms[e], {beside, replicate, random}, samples);
    }
  }
}

}  // namespace imunoise
