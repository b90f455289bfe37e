// warm_up: an exponential approach to the final bias after power-on.

#include <algorithm>
#include <cmath>

#include "core/effect/columns.h"
#include "core/search/search_view.h"

namespace imunoise::effects {

const Effect& warm_up();

namespace {

enum WarmUpParameter : std::size_t { kWarmUpTau, kWarmUpOwn, kWarmUpAmplitude };

ShapeFrom warm_up_shape(const EffectTerm& term, const Subject& subject) {
  return [samples = term[kWarmUpTau] * subject.rate.value](Eigen::Index first) {
    return imunoise::warm_up(samples, first);
  };
}

Result<void> check_warm_up(const EffectTerm& term, const Subject& subject) {
  if (term[kWarmUpTau] * subject.rate.value < 1.0)
    return unfit(term, "tau is shorter than a sample");
  return {};
}

Regressors warm_up_regressors(const EffectTerm& term, const Subject& subject) {
  return shaped(subject, term[kWarmUpOwn] != 0.0, {"amplitude"}, warm_up_shape(term, subject));
}

void add_warm_up(const EffectTerm& term, const Subject& subject, std::size_t replicate,
                 const Eigen::VectorXd& coefficients, Eigen::VectorXd& to) {
  warm_up_shape(term, subject)(subject.parts[replicate].first).add(coefficients, to);
}

void simulate_warm_up(const EffectTerm& term, const SimulatedReplicate& at,
                      Eigen::VectorXd& samples) {
  const double own = term[kWarmUpOwn] != 0.0 ? at.random.normal() : 1.0;
  add_warm_up(term, at.beside, at.replicate,
              Eigen::VectorXd::Constant(1, own * term[kWarmUpAmplitude]), samples);
}

Suggestions search_warm_up(const SearchView& view) {
  const Subject& subject = view.subject();
  // From a few blocks to half a replicate; longer is a ramp. The package of a sensor on its board,
  // some 0.02 J/K behind 50 K/W, warms no faster than in a second.
  constexpr double kFastestPackage = 1.0;  // s
  const double longest = 0.5 * subject.seconds(view.current().longest());
  const double shortest = std::max(
      {kFastestPackage, 4.0 * view.slow().longest_block_seconds(), 16.0 / subject.rate.value});
  Suggestions out;
  if (shortest >= longest) return out;
  for (const bool own : {false, true}) {
    if (own && subject.replicates() == 1) continue;
    const SlowView::BestTime best = view.slow().best_time(shortest, longest, own, [&](double tau) {
      return view.over_time([&](double t) { return std::exp(-t / tau); });
    });
    out.push_back(
        {.cause = "warm_up",
         .added = EffectTerm(warm_up(), "", {{"tau", best.seconds}, {"own", own ? 1.0 : 0.0}}),
         .score_nats = best.gain,
         .dof = own ? static_cast<double>(subject.replicates()) : 1.0,
         .search = {.path = best.path},
         .information = best.information,
         .shape_error = best.log_error});
  }
  return out;
}

}  // namespace

const Effect& warm_up() {
  static const Effect kWarmUp{
      .name = "warm_up",
      .title = "warm-up",
      .meaning = "Adds exp(-t/tau) from the first sample on.",
      .parameters = {{.name = "tau",
                      .meaning = "time constant",
                      .unit = "s",
                      .required = true,
                      .reported = "tau_s",
                      .rounding = Rounding::kFourDigits,
                      .error = ShapeError::kLogarithm},
                     {.name = "own",
                      .meaning = "separate amplitude in each replicate",
                      .form = ParameterForm::kFlag},
                     {.name = "amplitude",
                      .meaning =
                          "value at the first sample; with own, its standard deviation over the "
                          "replicates",
                      .lower = -1e15,
                      .reported = "amplitude",
                      .truth = true}},
      .coefficient = "amplitude",
      .causes = {{.id = "warm_up",
                  .title = "warm-up",
                  .physics = "The device heats itself after power-on, and its bias settles with "
                             "that time constant.",
                  .record_next = "two more power-ons from cold: the time constant must come back",
                  .looks_like = {"rate_ramp", "temperature", "step"},
                  .family = "warm_up",
                  .slow = true}},
      .check = check_warm_up,
      .regressors = warm_up_regressors,
      .add = add_warm_up,
      .simulate = simulate_warm_up,
      .search = search_warm_up,
  };
  return kWarmUp;
}

}  // namespace imunoise::effects
