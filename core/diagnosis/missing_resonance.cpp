#include "core/diagnosis/missing_resonance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/diagnosis/candidates.h"

namespace imunoise {
namespace {

// Of one damping, over their frequencies.
std::vector<Process> resonance_family(double damping, double lowest) {
  std::vector<Process> out;
  for (double f = lowest; f < 0.48; f *= 1.0 + 0.7 * damping) {
    const double omega = 2.0 * std::numbers::pi * f;
    out.emplace_back(Resonance{1.0, std::exp(-damping * omega), omega});
  }
  return out;
}

// Its last term in another process.
Model with_last(Model noise, const Process& process) {
  noise.terms.back() = Term(process);
  return noise;
}

// The likeliest spread resonance next to a resonance, with the noise beside it as it is fitted.
WhittleEstimate best_spread(const Model& sharp, const Resonance& peak, const Current& current) {
  WhittleEstimate best;
  best.objective = INFINITY;
  const double half_width = -std::log(peak.r);
  for (const double share : {0.2, 0.6}) {
    // A part of the width is spread, the rest damping; what drives it keeps the power.
    const double r = std::exp(-(1.0 - share) * half_width);
    const double spread = std::clamp(share * half_width, 2e-4, 0.5);
    const Voigt start{peak.sigma2 * (1.0 - share), r, peak.omega, spread};
    WhittleEstimate found = whittle(with_last(sharp, Process(start)), current.pooled);
    if (found.objective < best.objective) best = std::move(found);
  }
  return best;
}

template <class P>
const P* last_of(const Model& model) {
  for (auto term = model.terms.rbegin(); term != model.terms.rend(); ++term) {
    if (const P* const found = std::get_if<P>(&term->process)) return found;
  }
  return nullptr;
}

// As broad as its distance from frequency zero it is no peak, and takes the place of slow noise.
bool is_peak(const Voigt& found) {
  return found.omega > 2.0 * std::hypot(-std::log(found.r), 1.2 * found.spread);
}

// A peak of another form than a damped oscillation gives, where that explains clearly more: with
// one parameter more chance gains 6 nats once in 2,000.
void spread_where_needed(const Current& current, Suggestion& out) {
  constexpr double kClearly = 6.0;
  constexpr double kWorthIt = 10.0;  // nats: a fainter peak has no form
  if (out.score_nats < kWorthIt) return;
  const Model& start = std::get<NoiseChange>(out.added).start;
  const Resonance peak = std::get<Resonance>(start.terms.back().process);
  const double sharp = whittle(start, current.pooled).objective;
  WhittleEstimate spread = best_spread(start, peak, current);
  const Voigt* const found = last_of<Voigt>(spread.model);
  if (found == nullptr || !(spread.objective < sharp - kClearly) || !is_peak(*found)) return;
  const Process added(*found);
  out.added = NoiseChange{std::move(spread.model), added};
}

bool is_sought(const Term& term) {
  const bool rings = std::holds_alternative<Resonance>(term.process) ||
                     std::holds_alternative<Voigt>(term.process);
  return rings && std::none_of(term.given.begin(), term.given.end(), [](bool one) { return one; });
}

// The best resonance beside a fit, as a resonance or spread, as `like` is.
std::optional<FittedModel> grown(const FittedModel& fitted, const Process& like) {
  const Current current = current_of(fitted.regression, fitted.fit);
  const ScoreSpace space(current);
  const Suggestions found = search_resonances(current, space);
  if (found.empty()) return std::nullopt;
  Suggestion best = found.front();
  auto& change = std::get<NoiseChange>(best.added);
  if (change.added.index() != like.index()) {
    Model start = fitted.fit.model.noise;
    if (const auto* const spread = std::get_if<Voigt>(&change.added)) {
      const double width = std::hypot(-std::log(spread->r), spread->spread);
      const Process peak = Resonance{spread->sigma2, std::exp(-width), spread->omega};
      start.terms.emplace_back(peak);
      change = {std::move(start), peak};
    } else {
      const Resonance peak = std::get<Resonance>(change.added);
      start.terms.emplace_back(Process(peak));
      WhittleEstimate spread_fit = best_spread(start, peak, current);
      change = {std::move(spread_fit.model), like};
    }
  }
  return fit_with(current, best);
}

}  // namespace

Suggestions search_resonances(const Current& current, const ScoreSpace& space) {
  const auto longest = static_cast<double>(current.subject().length(current.longest()));
  Suggestions all;
  for (const double damping : {0.005, 0.02, 0.08, 0.25})
    add_best(current, space, "resonance", resonance_family(damping, 20.0 / longest), all);
  if (all.empty()) return all;
  double path = 0.0;
  for (const Suggestion& one : all) path += one.search.path;
  Suggestion best = *std::max_element(
      all.begin(), all.end(),
      [](const Suggestion& a, const Suggestion& b) { return a.score_nats < b.score_nats; });
  best.search.path = path;
  spread_where_needed(current, best);
  return {std::move(best)};
}

FittedModel fit_with_resonances(const std::shared_ptr<const Subject>& subject,
                                const FullModel& start, const Progress& progress) {
  FittedModel out = fit_full_model(subject, start, progress);
  FullModel rest = start;
  std::vector<Process> sought;
  std::erase_if(rest.noise.terms, [&](const Term& term) {
    if (is_sought(term)) sought.push_back(term.process);
    return is_sought(term);
  });
  if (sought.empty() || rest.noise.terms.empty()) return out;
  FittedModel found = fit_full_model(subject, rest, progress);
  for (const Process& like : sought) {
    auto more = grown(found, like);
    if (!more || progress.stopped()) return out;
    found = std::move(*more);
  }
  return found.fit.log_likelihood > out.fit.log_likelihood ? found : out;
}

}  // namespace imunoise
