#include "core/diagnosis/missing_filter.h"

#include <algorithm>
#include <cmath>

namespace imunoise {
namespace {

// White noise that a sensor averages over a window which is no multiple of the sampling interval,
// as where a host reads it at a pace of its own: neighbours share a part of the window. Offered
// where it explains clearly more than filters of known length.
void add_free_filter(const Current& current, std::size_t place, double before, Suggestions& out) {
  constexpr double kClearly = 6.0;
  Model changed = current.fit.model.noise;
  const double sigma2 = values(changed.terms[place].process)[0];
  const MovingAverage start{0.9 * sigma2, {0.1}};
  changed.terms[place] = Term(start);
  WhittleEstimate found = whittle(changed, current.pooled);
  const double gain = before - found.objective;
  const bool special = std::any_of(out.begin(), out.end(), [&](const Suggestion& other) {
    return other.cause == "low_pass" && other.score_nats > gain - kClearly;
  });
  const auto filter = std::find_if(
      found.model.terms.begin(), found.model.terms.end(),
      [](const Term& term) { return std::holds_alternative<MovingAverage>(term.process); });
  const Process added = filter->process;
  // A tap below zero is no filter: quantisation takes power away.
  const bool averages = std::get<MovingAverage>(added).theta[0] > 0.0;
  out.push_back({.cause = "low_pass",
                 .added = NoiseChange{std::move(found.model), added},
                 .score_nats = averages && !special ? std::max(gain, 0.0) : 0.0});
}

}  // namespace

Suggestions search_filters(const Current& current) {
  const Model& noise = current.fit.model.noise;
  const auto white = std::find_if(noise.terms.begin(), noise.terms.end(), [](const Term& term) {
    return std::holds_alternative<WhiteNoise>(term.process) && !term.given[0];
  });
  if (white == noise.terms.end()) return {};
  const auto place = static_cast<std::size_t>(white - noise.terms.begin());
  const double sigma2 = values(white->process)[0];
  const std::vector<int> lengths{2, 3, 4, 5, 6, 8, 10, 12, 16};
  Suggestions out;
  const double before = whittle_objective(noise, current.pooled);
  for (const bool twice : {false, true}) {
    Suggestion best{.cause = "low_pass",
                    .added = NoiseChange{},
                    .search = {.log_places = std::log(static_cast<double>(lengths.size()))}};
    for (const int n : lengths) {
      Model changed = noise;
      const Process filter =
          twice ? Process(BartlettFilter{sigma2, n}) : Process(MovingAverageFilter{sigma2, n});
      changed.terms[place] = Term(filter);
      const double gain = before - whittle(changed, current.pooled).objective;
      if (!(gain > best.score_nats)) continue;
      best.score_nats = gain;
      best.added = NoiseChange{std::move(changed), filter};
    }
    out.push_back(std::move(best));
  }
  add_free_filter(current, place, before, out);
  return out;
}

}  // namespace imunoise
