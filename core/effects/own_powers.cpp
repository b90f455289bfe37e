// own_powers: every replicate has noise powers of its own, or a whole spectrum of its own.

#include "core/effects/own_powers.h"

#include <algorithm>
#include <cmath>

#include "core/regression/own_ratios.h"
#include "core/search/search_view.h"
#include "core/search/shape_spread.h"
#include "core/support/distributions.h"
#include "core/support/parallel.h"

namespace imunoise::effects {

const Effect& own_powers();

namespace {

using Index = Eigen::Index;

enum OwnPowersParameter : std::size_t { kOwnPowersSpread, kOwnPowersShapes };

bool with_shapes(const EffectTerm& term) { return term[kOwnPowersShapes] != 0.0; }

// The model with all that is not a power held as it is.
Model powers_only(Model model) {
  for (Term& term : model.terms) {
    for (std::size_t p = 1; p < term.given.size(); ++p) term.given[p] = true;
  }
  return model;
}

void fit_own_powers(const EffectTerm& term, const Regression& regression, JointFit& fit) {
  const std::vector<BandedPower> residual = regression.residual(fit.effects.value);
  std::vector<WhittleEstimate> found(residual.size());
  for_each_index(residual.size(), [&](std::size_t i) {
    const std::span<const BandedPower> measured(&residual[i], 1);
    found[i] = own_noise_of(term, fit.model.noise, fit.model.noise, measured);
    if (fit.own_noise.empty() || !with_shapes(term)) return;
    const Model& start = fit.own_noise[regression.replicates()[i]];
    WhittleEstimate other = own_noise_of(term, fit.model.noise, start, measured);
    if (other.objective < found[i].objective) found[i] = std::move(other);
  });
  fit.log_likelihood = 0.0;
  fit.own_noise.assign(regression.subject().replicates(), fit.model.noise);
  for (std::size_t i = 0; i < found.size(); ++i) {
    fit.log_likelihood -= found[i].objective;
    fit.own_noise[regression.replicates()[i]] = found[i].model;
  }
}

void simulate_own_powers(const EffectTerm& term, const SimulatedReplicate& at,
                         Eigen::VectorXd& samples) {
  samples *= std::exp(0.5 * term[kOwnPowersSpread] * at.random.normal());
}

std::vector<ReportedNumber> own_powers_numbers(const FittedEffect& effect) {
  return own_ratios(effect, with_shapes(effect.term()));
}

// What could differ between replicates: powers, and with them shapes.
struct FreeNumbers {
  double powers = 0.0;
  double shapes = 0.0;
};

FreeNumbers free_numbers(const Model& noise) {
  FreeNumbers out;
  for (const Term& term : noise.terms) {
    if (!(values(term.process)[0] > 0.0)) continue;
    if (!term.given[0]) ++out.powers;
    for (std::size_t p = 1; p < term.given.size(); ++p) out.shapes += term.given[p] ? 0.0 : 1.0;
  }
  return out;
}

// What a spectrum that all replicates share could still gain at most, nats, less what it would gain
// by chance.
double common_misfit(const Current& current) {
  double out = 0.0;
  for (const BandedPower& bands : current.pooled) {
    const Eigen::ArrayXd ratio = bands.power / spectrum(current.fit.model.noise, bands.frequency);
    out += (0.5 * bands.count * (ratio - 1.0 - ratio.log()) - 0.5).sum();
  }
  return out;
}

Suggestion suggested(const Current& current, bool shapes, double dof) {
  const EffectTerm own(own_powers(), "", {{"shapes", shapes ? 1.0 : 0.0}});
  const JointFit apart = joint_fit(current.regression.with(own), current.fit.model.noise);
  return {.cause = shapes ? "replicate_bandwidth" : "replicate_change",
          .added = own,
          .score_nats = apart.log_likelihood - current.fit.log_likelihood,
          .dof = dof};
}

// Replicates that differ, as it counts.
struct Counted {
  double nats;
  double dof;
  double inflation;
  double noise_dof;

  double log_p() const { return log_p_value(nats, dof, noise_dof, false); }
};

// Where the power wanders within replicates, their means differ, too; their shapes do not. Either
// may be the better evidence: all that differs, were it as uncertain as the means, or the shapes
// alone.
Suggestions beside_wander(Suggestions all, const SearchView& view) {
  const PowerView* const power = view.power();
  const PowerView::Spread means = power == nullptr ? PowerView::Spread{} : power->of_means();
  if (!(means.inflation > 1.0)) return all;
  const double others = static_cast<double>(view.subject().replicates()) - 1.0;
  const double levels = level_gain(view.innovations());
  const ShapeSpread shapes = shape_spread(view.innovations());
  for (Suggestion& one : all) {
    const double gain = one.score_nats;
    Counted best{gain / means.inflation, one.dof, means.inflation, means.dof};
    Counted alone{(gain - levels) / shapes.inflation, one.dof - others, 1.0, shapes.dof};
    alone.inflation = gain / alone.nats;
    if (alone.nats > 0.0 && alone.dof > 0.0 && alone.log_p() < best.log_p()) best = alone;
    one.score_nats = best.nats;
    one.dof = best.dof;
    one.noise_dof = best.noise_dof;
    one.inflation = best.inflation;
  }
  return all;
}

Suggestions search_own_powers(const SearchView& view) {
  const Current& current = view.current();
  // What modulates the noise has made it differ between replicates, and the likelihood of their
  // powers does not know.
  const bool modulated = !current.fit.modulation.empty();
  if (view.subject().replicates() == 1 || !current.fit.own_noise.empty() || modulated) return {};
  const double others = static_cast<double>(view.subject().replicates()) - 1.0;
  const FreeNumbers free = free_numbers(current.fit.model.noise);
  Suggestions out{suggested(current, false, others * free.powers)};
  if (!(free.shapes > 0.0)) return beside_wander(std::move(out), view);
  // Shapes are offered where they explain clearly more than powers alone, which are simpler, and
  // than a better spectrum for all could: spectra of their own hide what is missing in all.
  Suggestion shapes = suggested(current, true, others * (free.powers + free.shapes));
  constexpr double kClearly = 6.0;
  const double chance = 0.5 * others * free.shapes;
  const bool clearly = shapes.score_nats - out[0].score_nats > 2.0 * chance + kClearly;
  if (clearly && shapes.score_nats > 2.0 * common_misfit(current)) out.push_back(std::move(shapes));
  return beside_wander(std::move(out), view);
}

// Power that wanders slowly makes replicates differ, too.
bool could_wander(const Current& current) {
  const auto view = PowerView::of(innovations(current.regression, current.fit));
  return view && !view->rules_out_wander();
}

// The logarithm of each replicate's power is a straight line over the means of a witness, but for
// what chance leaves: with two replicates it always is.
bool follows_means(const Innovations& innovations, const Witness& channel) {
  const auto count = static_cast<Index>(innovations.white.size());
  if (count < 3 || channel.levels.empty()) return false;
  Eigen::ArrayXd power(count);   // logarithms
  Eigen::ArrayXd weight(count);  // 1/variance
  Eigen::ArrayXd level(count);
  for (Index i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const auto samples = static_cast<double>(innovations.white[at].size());
    power(i) = std::log(innovations.white[at].squaredNorm() / samples);
    weight(i) = 0.5 * samples;
    level(i) = channel.levels[innovations.replicates[at]];
  }
  level -= (weight * level).sum() / weight.sum();
  power -= (weight * power).sum() / weight.sum();
  const double square = (weight * level.square()).sum();
  if (!(square > 0.0)) return false;
  const double slope = (weight * level * power).sum() / square;
  const double left = (weight * (power - slope * level).square()).sum();
  constexpr double kChance = 0.01;
  return chi_square_tail(left, static_cast<double>(count - 2)) > kChance;
}

bool could_follow(const Current& current) {
  const Innovations all = innovations(current.regression, current.fit);
  const std::vector<Witness>& channels = current.subject().witnesses;
  return std::any_of(channels.begin(), channels.end(),
                     [&](const Witness& one) { return follows_means(all, one); });
}

// Slow: of the noise that each replicate has of its own, white noise alone explains less than half.
void review_own_powers(const Current& current, TriedTerm& tried) {
  if (could_wander(current)) tried.could_be.push_back("variance_wander");
  if (!with_shapes(*tried.term()) && could_follow(current))
    tried.could_be.push_back("modulated_variance");
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

WhittleEstimate own_noise_of(const EffectTerm& term, const Model& shared, const Model& own,
                             std::span<const BandedPower> measured) {
  return whittle(with_shapes(term) ? own : powers_only(shared), measured, {}, Begin::kNear);
}

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
                      .truth = true},
                     {.name = "shapes",
                      .meaning = "correlation times, frequencies and filters differ, too",
                      .form = ParameterForm::kFlag}},
      .causes = {{.id = "replicate_change",
                  .title = "noise that differs between replicates",
                  .physics = "The device, its surroundings or its settings were not the same in "
                             "every replicate.",
                  .record_next = "more replicates, with everything that could differ written down",
                  .looks_like = {"modulated_variance"},
                  .family = "replicate_change"},
                 {.id = "replicate_bandwidth",
                  .title = "a spectrum that differs between replicates",
                  .physics = "The sampling rate or the sensor's filter was not the same in every "
                             "replicate: the host read the sensor at another pace, or a register "
                             "was set differently.",
                  .record_next = "the clock time of every sample and the filter settings of every "
                                 "replicate",
                  .looks_like = {"replicate_change"},
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
