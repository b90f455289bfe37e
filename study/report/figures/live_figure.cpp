#include "study/report/figures/live_figure.h"

#include "study/report/figures/budget_figure.h"

namespace imunoise::report {

std::optional<figure::Figure> live_figure(const v1::LiveChannel& channel) {
  BudgetView view;
  for (const v1::LiveScale& one : channel.scales()) {
    view.scales.push_back({.index = view.scales.size(),
                           .seconds = one.tau_s(),
                           .measured = one.deviation() * one.deviation(),
                           .lower = one.lower() * one.lower(),
                           .upper = one.upper() * one.upper(),
                           .tested = !(one.enough_in_s() > 0.0),
                           .terms = {}});
  }
  if (view.scales.size() < 2) return std::nullopt;
  figure::Figure out = budget_figure(
      as_allan(std::move(view), allan_unit(channel.units())),
      {.channel = channel.channel(), .unit = channel.units(), .confidence = 0.95, .allan = true});
  out.sentence = "Allan deviation of " + channel.channel() + " so far";
  out.caption =
      "Allan deviation against its averaging time, from the samples so far, with 95 % intervals. "
      "Grey: not known within a factor of two yet.";
  return out;
}

}  // namespace imunoise::report
