// ramp: a constant slope.

#include "core/effect/columns.h"
#include "core/search/search_view.h"

namespace imunoise::effects {

const Effect& ramp();

namespace {

enum RampParameter : std::size_t { kRampOwn, kRampSlope };

ShapeFrom ramp_shape(const Subject& subject) {
  return [rate = subject.rate.value](Eigen::Index) { return imunoise::ramp(rate); };
}

Regressors ramp_regressors(const EffectTerm& term, const Subject& subject) {
  return shaped(subject, term[kRampOwn] != 0.0, {"slope"}, ramp_shape(subject));
}

void add_ramp(const EffectTerm&, const Subject& subject, std::size_t,
              const Eigen::VectorXd& coefficients, Eigen::VectorXd& to) {
  ramp_shape(subject)(0).add(coefficients, to);
}

void simulate_ramp(const EffectTerm& term, const SimulatedReplicate& at, Eigen::VectorXd& samples) {
  const double own = term[kRampOwn] != 0.0 ? at.random.normal() : 1.0;
  add_ramp(term, at.beside, at.replicate, Eigen::VectorXd::Constant(1, own * term[kRampSlope]),
           samples);
}

std::string ramp_unit(const EffectTerm&, const Subject& subject) {
  if (subject.quantity == Quantity::kAngularRate) return "rad/s²";
  if (subject.quantity == Quantity::kAcceleration) return "m/s³";
  return std::string(si_symbol(subject.quantity)) + "/s";
}

Suggestions search_ramp(const SearchView& view) {
  const auto replicates = static_cast<double>(view.subject().replicates());
  const Eigen::VectorXd whitened = view.slow().whitened(view.over_time([](double t) { return t; }));
  Suggestions out;
  for (const bool own : {false, true}) {
    if (own && view.subject().replicates() == 1) continue;
    out.push_back({.cause = "rate_ramp",
                   .added = EffectTerm(ramp(), "", {{"own", own ? 1.0 : 0.0}}),
                   .score_nats = view.slow().gain(whitened, own),
                   .dof = own ? replicates : 1.0,
                   .information = whitened.squaredNorm()});
  }
  return out;
}

}  // namespace

const Effect& ramp() {
  static const Effect kRamp{
      .name = "ramp",
      .title = "ramp",
      .meaning = "Adds a constant slope.",
      .parameters = {{.name = "own",
                      .meaning = "separate slope in each replicate",
                      .form = ParameterForm::kFlag},
                     {.name = "slope",
                      .meaning = "slope; with own, its standard deviation over the replicates",
                      .lower = -1e15,
                      .reported = "slope",
                      .truth = true}},
      .coefficient = "slope",
      .causes = {{.id = "rate_ramp",
                  .title = "ramp",
                  .physics = "The bias changes at a constant rate: ageing, or a temperature that "
                             "rises steadily.",
                  .record_next = "longer, together with the temperature",
                  .looks_like = {"warm_up", "temperature", "random_walk", "step"},
                  .family = "rate_ramp",
                  .slow = true}},
      .unit = ramp_unit,
      .regressors = ramp_regressors,
      .add = add_ramp,
      .simulate = simulate_ramp,
      .search = search_ramp,
  };
  return kRamp;
}

}  // namespace imunoise::effects
