// own_powers: every replicate has noise powers of its own.

#include <fmt/format.h>

#include <cmath>

#include "core/effect/columns.h"
#include "core/search/search_view.h"

namespace imunoise::effects {

const Effect& own_powers();

namespace {

enum OwnPowersParameter : std::size_t { kOwnPowersSpread };

// The model with all that is not a power held as it is.
Model powers_only(Model model) {
  for (Term& term : model.terms) {
    for (std::size_t p = 1; p < term.given.size(); ++p) term.given[p] = true;
  }
  return model;
}

void fit_own_powers(const Regression& regression, JointFit& fit) {
  fit.log_likelihood = 0.0;
  for (const BandedPower& one : regression.residual(fit.effects.value)) {
    const WhittleEstimate found = whittle(powers_only(fit.model.noise), std::span(&one, 1));
    fit.log_likelihood -= found.objective;
    fit.own_noise.push_back(found.model);
  }
}

void simulate_own_powers(const EffectTerm& term, const SimulatedReplicate& at,
                         Eigen::VectorXd& samples) {
  samples *= std::exp(0.5 * term[kOwnPowersSpread] * at.random.normal());
}

// Mean logarithm of a replicate's powers over those of all.
double log_ratio(const Model& own, const Model& all) {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t t = 0; t < all.terms.size(); ++t) {
    const double one = values(own.terms[t].process)[0];
    const double common = values(all.terms[t].process)[0];
    if (!(one > 0.0 && common > 0.0)) continue;
    sum += std::log(one / common);
    ++count;
  }
  return count > 0.0 ? sum / count : 0.0;
}

std::vector<ReportedNumber> own_powers_numbers(const FittedEffect& effect) {
  const JointFit& fit = effect.model.fit;
  const auto replicates = static_cast<Eigen::Index>(fit.own_noise.size());
  Eigen::ArrayXd ratios(replicates);
  for (Eigen::Index k = 0; k < replicates; ++k)
    ratios(k) = log_ratio(fit.own_noise[static_cast<std::size_t>(k)], fit.model.noise);
  std::vector<ReportedNumber> out;
  if (replicates > 1) {
    const double dof = static_cast<double>(replicates - 1);
    const double spread = std::sqrt((ratios - ratios.mean()).square().sum() / dof);
    out.push_back(with_log_error({"spread", spread, "1"}, 1.0 / std::sqrt(2.0 * dof)));
  }
  for (Eigen::Index k = 0; k < replicates; ++k)
    out.push_back({fmt::format("power ratio of replicate {}", k + 1), std::exp(ratios(k)), "1"});
  return out;
}

// Powers that could differ between replicates.
double free_powers(const Model& noise) {
  double out = 0.0;
  for (const Term& term : noise.terms) {
    if (!term.given[0] && values(term.process)[0] > 0.0) ++out;
  }
  return out;
}

Suggestions search_own_powers(const SearchView& view) {
  const Current& current = view.current();
  const auto replicates = static_cast<double>(view.subject().replicates());
  // What modulates the noise has made it differ between replicates, and the likelihood of their
  // powers does not know.
  const bool modulated = !current.fit.modulation.empty();
  if (view.subject().replicates() == 1 || !current.fit.own_noise.empty() || modulated) return {};
  const EffectTerm own(own_powers());
  const JointFit apart = joint_fit(current.regression.with(own), current.fit.model.noise);
  return {{.cause = "replicate_change",
           .added = own,
           .score_nats = apart.log_likelihood - current.fit.log_likelihood,
           .dof = (replicates - 1.0) * free_powers(current.fit.model.noise)}};
}

// Of the noise that each replicate has of its own, white noise alone explains less than half.
void review_own_powers(const Current& current, TriedTerm& tried) {
  const Regression& regression = tried.fitted.regression;
  const Model& noise = current.fit.model.noise;
  Model held = noise;
  for (Term& term : held.terms)
    term.given.assign(term.given.size(), !std::holds_alternative<WhiteNoise>(term.process));
  double fast = 0.0;
  for (const BandedPower& one : regression.residual(tried.fitted.fit.effects.value)) {
    const std::span<const BandedPower> alone(&one, 1);
    fast += whittle_objective(noise, alone) - whittle(held, alone).objective;
  }
  tried.slow = fast < 0.5 * (tried.fitted.fit.log_likelihood - current.fit.log_likelihood);
}

}  // namespace

const Effect& own_powers() {
  static const Effect kOwnPowers{
      .name = "own_powers",
      .title = "powers of each replicate",
      .meaning = "Gives every replicate its own noise powers.",
      .parameters = {{.name = "spread",
                      .meaning = "standard deviation over the replicates of the logarithm of the "
                                 "noise power",
                      .unit = "1",
                      .reported = "spread",
                      .truth = true}},
      .causes = {{.id = "replicate_change",
                  .title = "noise that differs between replicates",
                  .physics = "The device, its surroundings or its settings were not the same in "
                             "every replicate.",
                  .record_next = "more replicates, with everything that could differ written down",
                  .looks_like = {"modulated_variance"},
                  .family = "replicate_change"}},
      .own_noise = fit_own_powers,
      .simulate = simulate_own_powers,
      .search = search_own_powers,
      .review = review_own_powers,
      .numbers = own_powers_numbers,
  };
  return kOwnPowers;
}

}  // namespace imunoise::effects
