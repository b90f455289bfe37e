#include <algorithm>
#include <cmath>

#include "core/diagnosis/scan.h"
#include "core/diagnosis/two_levels.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

void add_step(const Current& current, const std::vector<StepProducts>& steps, Suggestions& out) {
  Suggestion best{.effect = "step", .added = EffectTerm{.kind = EffectKind::kStep}};
  const Subject& subject = current.subject();
  for (std::size_t k = 0; k < steps.size(); ++k) {
    best.search.path += steps[k].path();
    for (Index t = 1; t < steps[k].size(); ++t) {
      const double product = steps[k].product(t);
      const double information = steps[k].information(t, t);
      if (!(0.5 * product * product > best.score_nats * information)) continue;
      best.score_nats = 0.5 * product * product / information;
      best.information = information;
      best.added =
          EffectTerm{.kind = EffectKind::kStep,
                     .replicate = static_cast<double>(subject.parts[k].recorded + 1),
                     .time = static_cast<double>(subject.parts[k].first + t) / subject.rate.value};
    }
  }
  if (best.score_nats > 0.0) out.push_back(std::move(best));
}

// With fewer jumps it is a step.
void add_telegraph(const std::vector<StepProducts>& steps, Suggestions& out) {
  constexpr std::size_t kFewestJumps = 3;
  const TwoLevels found = find_two_levels(steps);
  if (found.jumps < kFewestJumps) return;
  out.push_back({.effect = "telegraph",
                 .added = EffectTerm{.kind = EffectKind::kTelegraph},
                 .score_nats = found.gain_nats,
                 .search = {.log_places = log_places(found.courses)}});
}

}  // namespace

Suggestions scan_steps(const Current& current) {
  const std::vector<StepProducts> steps = step_products(current);
  Suggestions out;
  add_step(current, steps, out);
  const auto& effects = current.regression.effects();
  if (std::none_of(effects.begin(), effects.end(),
                   [](const EffectTerm& term) { return term.kind == EffectKind::kTelegraph; })) {
    add_telegraph(steps, out);
  }
  return out;
}

}  // namespace imunoise
