#include "core/diagnosis/useless.h"

#include <algorithm>
#include <cmath>

namespace imunoise {
namespace {

bool adds_up(const EffectTerm& term) {
  return term.kind == EffectKind::kRamp || term.kind == EffectKind::kWarmUp ||
         term.kind == EffectKind::kLine || term.kind == EffectKind::kStep ||
         term.kind == EffectKind::kWitness;
}

UselessTerm weighed(const Trial& with, std::string term, Regression regression,
                    const Model& start) {
  JointFit fit = joint_fit(regression, start);
  const double loss = with.fit.log_likelihood - fit.log_likelihood;
  return {std::move(term), loss, {std::move(regression), std::move(fit)}};
}

}  // namespace

std::optional<UselessTerm> useless_term(const Trial& trial, double level) {
  const Model& noise = trial.fit.model.noise;
  const std::vector<EffectTerm>& effects = trial.regression.effects();
  std::optional<UselessTerm> out;
  double highest = std::log(level);
  const auto weigh = [&](UselessTerm one, double dof) {
    const double chance = log_chance(std::max(0.0, one.loss), dof, INFINITY, false);
    if (!(chance > highest)) return;
    highest = chance;
    out = std::move(one);
  };
  for (std::size_t t = 0; t < noise.terms.size() && noise.terms.size() > 1; ++t) {
    const std::vector<bool>& given = noise.terms[t].given;
    const auto free = std::count(given.begin(), given.end(), false);
    if (free < static_cast<std::ptrdiff_t>(given.size())) continue;  // somebody wants it so
    Model without = noise;
    without.terms.erase(without.terms.begin() + static_cast<std::ptrdiff_t>(t));
    Model alone;
    alone.terms.push_back(noise.terms[t]);
    weigh(weighed(trial, print(alone), trial.regression, without), static_cast<double>(free));
  }
  for (std::size_t e = 0; e < effects.size(); ++e) {
    if (!adds_up(effects[e])) continue;
    const auto coefficients =
        static_cast<double>(trial.regression.first(e + 1) - trial.regression.first(e));
    weigh(weighed(trial, print(effects[e]), trial.regression.without(e), noise), coefficients);
  }
  return out;
}

}  // namespace imunoise
