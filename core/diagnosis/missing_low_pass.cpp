#include "core/diagnosis/missing_low_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/diagnosis/bandwidth.h"
#include "core/model/similar_term.h"

namespace imunoise {
namespace {

constexpr double kLowestCutoff = 0.01;  // rad per sample
constexpr double kHighestCutoff = 3.0;
constexpr double kCutoffStep = 1.3;
constexpr std::array kOrders = {1, 2, 3, 4, 5, 6, 8};
constexpr int kTypicalOrder = 2;

// A filter in place of a term; or beside white noise, which is what the converter adds behind it.
struct FilterPlace {
  std::size_t term = 0;
  bool beside = false;
};

struct Filter {
  bool digital = false;
  int order = kTypicalOrder;
  double omega = 1.0;  // cut-off, rad per sample

  Process process(double sigma2) const {
    return digital ? Process(DigitalFilter{sigma2, omega, order})
                   : Process(AnalogFilter{sigma2, omega, order});
  }
  bool exists() const {
    return order >= (digital ? DigitalFilter::kSmallest : AnalogFilter::kSmallest);
  }
};

bool may_be_filtered(const Term& term) {
  if (std::find(term.given.begin(), term.given.end(), true) != term.given.end()) return false;
  if (const auto* const rings = std::get_if<Resonance>(&term.process)) return !rings->has_peak();
  return std::holds_alternative<WhiteNoise>(term.process) ||
         std::holds_alternative<MovingAverage>(term.process) || is_fast(term.process);
}

std::vector<FilterPlace> filter_places(const Model& noise) {
  std::vector<FilterPlace> out;
  for (std::size_t t = 0; t < noise.terms.size(); ++t) {
    if (!may_be_filtered(noise.terms[t])) continue;
    out.push_back({t, false});
    if (std::holds_alternative<WhiteNoise>(noise.terms[t].process)) out.push_back({t, true});
  }
  return out;
}

// The noise as it is, and what is measured.
struct Seen {
  const Model& noise;
  std::vector<BandedPower> pooled;
};

// What is measured from one frequency to another, rad per sample, over what a process of unit power
// has there; without the noise beside it.
double filter_level(const Seen& seen, const Model& beside, const Process& unit, double from,
                    double to) {
  double sum = 0.0;
  double count = 0.0;
  for (const BandedPower& bands : seen.pooled) {
    Eigen::ArrayXd own = bands.power;
    if (!beside.terms.empty()) own -= spectrum(beside, bands.frequency);
    own /= spectrum(unit, bands.frequency);
    const Eigen::ArrayXd omega = 2.0 * std::numbers::pi * bands.frequency.cycles();
    const Eigen::ArrayXd weight = (omega >= from && omega < to).select(bands.count, 0.0);
    sum += (weight * own).sum();
    count += weight.sum();
  }
  return count > 0.0 ? std::max(0.0, sum / count) : 0.0;
}

// The current noise with a filter, its powers read off the spectrum.
Model with_filter(const Seen& seen, const FilterPlace& place, const Filter& filter) {
  Model out = seen.noise;
  Model beside = out;
  beside.terms.erase(beside.terms.begin() + static_cast<std::ptrdiff_t>(place.term));
  const double through = filter_level(seen, beside, filter.process(1.0), 0.0, filter.omega);
  const Term added(filter.process(through));
  if (!place.beside) {
    out.terms[place.term] = added;
    return out;
  }
  // Well above the cut-off, where the filter has left little.
  const double high = std::min(2.0 * filter.omega, 0.9 * std::numbers::pi);
  const double floor = filter_level(seen, beside, Process(WhiteNoise{1.0}), high, INFINITY);
  set_values(out.terms[place.term].process, std::vector<double>{std::min(floor, 0.5 * through)});
  out.terms.push_back(added);
  return out;
}

struct FoundFilter {
  WhittleEstimate fit;
  Process process;  // the filter as it was fitted
  FilterPlace place;
  Filter filter;
};

std::optional<FoundFilter> filter_fitted(const Seen& seen, const FilterPlace& place,
                                         const Filter& from) {
  WhittleEstimate fit = whittle(with_filter(seen, place, from), seen.pooled);
  const std::size_t kind = from.process(1.0).index();
  const auto term = std::find_if(fit.model.terms.begin(), fit.model.terms.end(),
                                 [&](const Term& one) { return one.process.index() == kind; });
  if (term == fit.model.terms.end()) return std::nullopt;
  const Process process = term->process;
  const double omega = ::imunoise::values(process)[1];
  return FoundFilter{std::move(fit), process, place, {from.digital, from.order, omega}};
}

void keep_likelier(std::optional<FoundFilter>& best, std::optional<FoundFilter> other) {
  if (other && (!best || other->fit.objective < best->fit.objective)) best = std::move(other);
}

// The cut-off from which a search should begin.
Filter likeliest_start(const Seen& seen, const FilterPlace& place, bool digital) {
  Filter out;
  double lowest = INFINITY;
  for (double omega = kHighestCutoff; omega > kLowestCutoff; omega /= kCutoffStep) {
    const Filter one{digital, kTypicalOrder, omega};
    const double at = whittle_objective(with_filter(seen, place, one), seen.pooled);
    if (!(at < lowest)) continue;
    lowest = at;
    out = one;
  }
  return out;
}

// The likeliest of typical order, in place of anything or beside it.
std::optional<FoundFilter> likeliest_place(const Seen& seen) {
  std::optional<FoundFilter> best;
  for (const FilterPlace& place : filter_places(seen.noise)) {
    for (const bool digital : {false, true})
      keep_likelier(best, filter_fitted(seen, place, likeliest_start(seen, place, digital)));
  }
  constexpr double kWorthALook = 3.0;  // nats
  const double before = whittle_objective(seen.noise, seen.pooled);
  if (best && best->fit.objective < before - kWorthALook) return best;
  return std::nullopt;
}

// The likeliest of any order, next to one.
std::optional<FoundFilter> likeliest(const Seen& seen, const FoundFilter& first) {
  std::optional<FoundFilter> best;
  for (const bool digital : {false, true}) {
    for (const int order : kOrders) {
      const Filter one{digital, order, first.filter.omega};
      if (one.exists()) keep_likelier(best, filter_fitted(seen, first.place, one));
    }
  }
  return best;
}

}  // namespace

Suggestion search_low_pass(const Current& current, Suggestions& others) {
  constexpr double kClearly = 6.0;
  const double cutoffs = std::log(kHighestCutoff / kLowestCutoff) / std::log(kCutoffStep);
  const double forms = 2.0 * static_cast<double>(kOrders.size());
  Suggestion out{.cause = "low_pass",
                 .added = NoiseChange{},
                 .search = {.log_places = std::log(cutoffs * forms)}};
  // A filter is broad: wide bands show whether there may be one, in a tenth of the time.
  Seen seen{current.fit.model.noise, {}};
  for (const BandedPower& one : current.pooled) seen.pooled.push_back(in_wider_bands(one));
  const std::optional<FoundFilter> first = likeliest_place(seen);
  if (!first) return out;
  seen.pooled = current.pooled;
  const std::optional<FoundFilter> best = likeliest(seen, *first);
  const double before = whittle_objective(seen.noise, seen.pooled);
  if (!best || !(best->fit.objective < before)) return out;
  const double reached = best->fit.objective;
  bool special = false;
  for (Suggestion& other : others) {
    const auto* const change = std::get_if<NoiseChange>(&other.added);
    if (change == nullptr || !(other.score_nats > 0.0)) continue;
    const WhittleEstimate fit = whittle(change->start, current.pooled);
    const auto term = similar_term(fit.model, change->added);
    if (!term || !hardly_rings(fit.model.terms[*term].process)) {
      special = special || fit.objective < reached + kClearly;
    } else if (fit.objective > reached - kClearly) {
      other.score_nats = 0.0;
    }
  }
  out.added = NoiseChange{best->fit.model, best->process};
  out.dof = best->place.beside ? 2.0 : 1.0;
  if (!special) out.score_nats = before - reached;
  return out;
}

}  // namespace imunoise
