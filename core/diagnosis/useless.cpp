#include "core/diagnosis/useless.h"

#include <algorithm>
#include <cmath>

#include "core/search/evidence.h"

namespace imunoise {
namespace {

// Terms whose regressors are known before the fit.
bool adds_up(const EffectTerm& term) {
  return term.effect->regressors != nullptr && term.effect->fit_with == nullptr;
}

// Terms of a kind of process.
std::ptrdiff_t count(const Model& model, std::size_t kind) {
  return std::count_if(model.terms.begin(), model.terms.end(),
                       [&](const Term& term) { return term.process.index() == kind; });
}

UselessTerm weighed(const FittedModel& with, std::string term, Regression regression,
                    const Model& start) {
  JointFit fit = joint_fit(regression, start, {}, Begin::kAnywhere, own_starts(with.fit, start));
  const double loss = with.fit.log_likelihood - fit.log_likelihood;
  return {std::move(term), loss, {std::move(regression), std::move(fit)}};
}

}  // namespace

std::optional<UselessTerm> useless_term(const FittedModel& fitted, double level,
                                        const Model& kept) {
  const Model& noise = fitted.fit.model.noise;
  const std::vector<EffectTerm>& effects = fitted.regression.effects();
  std::optional<UselessTerm> out;
  double highest = std::log(level);
  const auto weigh = [&](UselessTerm one, double dof) {
    const double log_p = log_p_value(std::max(0.0, one.loss), dof, INFINITY, false);
    if (!(log_p > highest)) return;
    highest = log_p;
    out = std::move(one);
  };
  for (std::size_t t = 0; t < noise.terms.size() && noise.terms.size() > 1; ++t) {
    const std::vector<bool>& given = noise.terms[t].given;
    const auto free = std::count(given.begin(), given.end(), false);
    if (free < static_cast<std::ptrdiff_t>(given.size())) continue;  // kept on purpose
    Model without = noise;
    without.terms.erase(without.terms.begin() + static_cast<std::ptrdiff_t>(t));
    Model alone;
    alone.terms.push_back(noise.terms[t]);
    const std::size_t kind = noise.terms[t].process.index();
    const bool has_power = values(noise.terms[t].process)[0] > 0.0;
    if (has_power && count(noise, kind) <= count(kept, kind)) continue;
    weigh(weighed(fitted, print(alone), fitted.regression, without), static_cast<double>(free));
  }
  for (std::size_t e = 0; e < effects.size(); ++e) {
    if (!adds_up(effects[e])) continue;
    const auto coefficients =
        static_cast<double>(fitted.regression.first(e + 1) - fitted.regression.first(e));
    weigh(weighed(fitted, print(effects[e]), fitted.regression.without(e), noise), coefficients);
  }
  return out;
}

}  // namespace imunoise
