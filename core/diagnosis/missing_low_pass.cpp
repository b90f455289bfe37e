#include "core/diagnosis/missing_low_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

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

// What is measured from one frequency to another, rad per sample, over what a process of unit power
// has there; without the noise beside it.
double filter_level(const Current& current, const Model& beside, const Process& unit, double from,
                    double to) {
  double sum = 0.0;
  double count = 0.0;
  for (const BandedPower& bands : current.pooled) {
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
Model with_filter(const Current& current, const FilterPlace& place, const Filter& filter) {
  Model out = current.fit.model.noise;
  Model beside = out;
  beside.terms.erase(beside.terms.begin() + static_cast<std::ptrdiff_t>(place.term));
  const double through = filter_level(current, beside, filter.process(1.0), 0.0, filter.omega);
  const Term added(filter.process(through));
  if (!place.beside) {
    out.terms[place.term] = added;
    return out;
  }
  // Well above the cut-off, where the filter has left little.
  const double high = std::min(2.0 * filter.omega, 0.9 * std::numbers::pi);
  const double floor = filter_level(current, beside, Process(WhiteNoise{1.0}), high, INFINITY);
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

std::optional<FoundFilter> filter_fitted(const Current& current, const FilterPlace& place,
                                         const Filter& from) {
  WhittleEstimate fit = whittle(with_filter(current, place, from), current.pooled);
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
Filter likeliest_start(const Current& current, const FilterPlace& place, bool digital) {
  Filter out;
  double lowest = INFINITY;
  for (double omega = kHighestCutoff; omega > kLowestCutoff; omega /= kCutoffStep) {
    const Filter one{digital, kTypicalOrder, omega};
    const double at = whittle_objective(with_filter(current, place, one), current.pooled);
    if (!(at < lowest)) continue;
    lowest = at;
    out = one;
  }
  return out;
}

std::optional<FoundFilter> likeliest(const Current& current, double before) {
  std::optional<FoundFilter> best;
  for (const FilterPlace& place : filter_places(current.fit.model.noise)) {
    for (const bool digital : {false, true})
      keep_likelier(best, filter_fitted(current, place, likeliest_start(current, place, digital)));
  }
  if (!best || !(best->fit.objective < before)) return std::nullopt;
  const FoundFilter first = *best;
  for (const bool digital : {false, true}) {
    for (const int order : kOrders) {
      const Filter one{digital, order, first.filter.omega};
      if (one.exists()) keep_likelier(best, filter_fitted(current, first.place, one));
    }
  }
  return best;
}

}  // namespace

bool is_fast(const Process& process) {
  constexpr double kFastest = 20.0;  // samples
  const std::vector<DerivedQuantity> all = derived(process, Hertz{1.0});
  return std::any_of(all.begin(), all.end(), [](const DerivedQuantity& one) {
    return one.coefficient == Coefficient::kCorrelationTime && one.value < kFastest;
  });
}

Suggestion search_low_pass(const Current& current, const Suggestions& others) {
  constexpr double kClearly = 6.0;
  const double cutoffs = std::log(kHighestCutoff / kLowestCutoff) / std::log(kCutoffStep);
  const double forms = 2.0 * static_cast<double>(kOrders.size());
  Suggestion out{.cause = "low_pass",
                 .added = NoiseChange{},
                 .search = {.log_places = std::log(cutoffs * forms)}};
  const double before = whittle_objective(current.fit.model.noise, current.pooled);
  const std::optional<FoundFilter> best = likeliest(current, before);
  if (!best) return out;
  const double reached = best->fit.objective;
  const bool special = std::any_of(others.begin(), others.end(), [&](const Suggestion& other) {
    const auto* const change = std::get_if<NoiseChange>(&other.added);
    return change != nullptr && other.score_nats > 0.0 &&
           whittle(change->start, current.pooled).objective < reached + kClearly;
  });
  out.added = NoiseChange{best->fit.model, best->process};
  out.dof = best->place.beside ? 2.0 : 1.0;
  if (!special) out.score_nats = before - reached;
  return out;
}

}  // namespace imunoise
