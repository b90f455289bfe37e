// step: the level changes at one time of one replicate.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/effect/columns.h"
#include "core/search/search_view.h"

namespace imunoise::effects {

const Effect& step();

namespace {

using Index = Eigen::Index;

enum StepParameter : std::size_t { kStepReplicate, kStepTime, kStepHeight };

std::size_t recorded_of(const EffectTerm& term) {
  return static_cast<std::size_t>(term[kStepReplicate]) - 1;
}

// The replicate that a step is in.
std::optional<std::size_t> stepping(const EffectTerm& term, const Subject& subject) {
  return subject.around(recorded_of(term), std::lround(term[kStepTime] * subject.rate.value));
}

Shape step_shape(const EffectTerm& term, const Subject& subject, std::size_t replicate) {
  return imunoise::step(std::lround(term[kStepTime] * subject.rate.value) -
                        subject.parts[replicate].first);
}

Result<void> check_step(const EffectTerm& term, const Subject& subject) {
  const std::size_t recorded = subject.parts.back().recorded + 1;
  if (term[kStepReplicate] > static_cast<double>(recorded))
    return unfit(term, fmt::format("there are only {} replicates", recorded));
  if (!stepping(term, subject))
    return unfit(term, "the replicate has no usable samples at that time");
  return {};
}

Regressors step_regressors(const EffectTerm& term, const Subject& subject) {
  Regressors out{std::vector<Columns>(subject.replicates()), {}};
  const std::size_t k = *stepping(term, subject);
  out.replicates[k] = {
      columns_of(step_shape(term, subject, k).cosines(subject.length(k))), {0}, {}};
  out.coefficients.push_back({"height", k});
  return out;
}

void add_step(const EffectTerm& term, const Subject& subject, std::size_t replicate,
              const Eigen::VectorXd& coefficients, Eigen::VectorXd& to) {
  step_shape(term, subject, replicate).add(coefficients, to);
}

void simulate_step(const EffectTerm& term, const SimulatedReplicate& at, Eigen::VectorXd& samples) {
  if (at.beside.parts[at.replicate].recorded != recorded_of(term)) return;
  add_step(term, at.beside, at.replicate, Eigen::VectorXd::Constant(1, term[kStepHeight]), samples);
}

// A level of fewer samples is no level. Where a filter leaves nearly no power at some frequency,
// that is where its ends show.
constexpr Index kFromEnds = 16;

Suggestions search_step(const SearchView& view) {
  const Subject& subject = view.subject();
  const std::vector<StepProducts>& steps = view.steps();
  Suggestion best{.cause = "step", .added = EffectTerm(step())};
  std::size_t replicate = 0;
  Index time = 0;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    best.search.path += steps[k].path();
    const Index apart = std::min(kFromEnds, steps[k].size() / 4);
    for (Index t = 1 + apart; t + apart < steps[k].size(); ++t) {
      const double product = steps[k].product(t);
      const double information = steps[k].information(t, t);
      if (!(0.5 * product * product > best.score_nats * information)) continue;
      best.score_nats = 0.5 * product * product / information;
      best.information = information;
      replicate = k;
      time = t;
    }
  }
  const Part& part = subject.parts[replicate];
  best.added = EffectTerm(step(), "",
                          {{"replicate", static_cast<double>(part.recorded + 1)},
                           {"t", static_cast<double>(part.first + time) / subject.rate.value}});
  return {best};
}

void step_numbers(const TriedTerm& tried, std::vector<ReportedNumber>& first,
                  std::vector<ReportedNumber>&) {
  first.push_back({"time_s", (*tried.term())[kStepTime], "s"});
  first.push_back({"replicate", (*tried.term())[kStepReplicate], "1"});
}

}  // namespace

const Effect& step() {
  static const Effect kStep{
      .name = "step",
      .title = "step",
      .meaning = "Changes the level of one replicate at one time.",
      .parameters = {{.name = "replicate",
                      .meaning = "number of the replicate as recorded, counted from 1",
                      .form = ParameterForm::kWholeNumber,
                      .required = true,
                      .lower = 1.0},
                     {.name = "t",
                      .meaning = "time from the first sample of what was recorded",
                      .unit = "s",
                      .required = true,
                      .rounding = Rounding::kBySample},
                     {.name = "height",
                      .meaning = "change of the level",
                      .lower = -1e15,
                      .reported = "height",
                      .truth = true}},
      .coefficient = "height",
      .anywhere = true,
      .causes = {{.id = "step",
                  .title = "step",
                  .physics = "Stress is released, a connector moves, or the bench is touched.",
                  .record_next = "nothing: cut the recording there, or keep the step in the model",
                  .looks_like = {"random_walk", "telegraph", "rate_ramp"},
                  .family = "step"}},
      .check = check_step,
      .regressors = step_regressors,
      .add = add_step,
      .simulate = simulate_step,
      .search = search_step,
      .more_numbers = step_numbers,
  };
  return kStep;
}

}  // namespace imunoise::effects
