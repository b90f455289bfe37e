#include <nlopt.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>

#include "core/estimate/problem.h"
#include "core/estimate/profile.h"
#include "core/estimate/starting_points.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

constexpr std::size_t kScanned = 6;    // starting points taken from the scan
constexpr std::size_t kExtended = 3;   // and from the best smaller model plus one term
constexpr int kMostEvaluations = 400;  // per starting point

struct Refined {
  std::vector<double> x;
  double objective = 0.0;
  Termination termination = Termination::kConverged;
};

// What NLopt's callback needs; it sees plain pointers and must not throw.
struct Search {
  const Profile& profile;
  double unit;  // the objective is handed over in units of its starting value
  Refined best;
};

double evaluate(unsigned n, const double* x, double* gradient, void* data) {
  auto& search = *static_cast<Search*>(data);
  std::vector<double> at(x, x + n);
  std::vector<double> slope(n);
  const Profile::Point point = search.profile.at(at, gradient != nullptr ? &slope : nullptr);
  if (point.objective < search.best.objective) {
    search.best.objective = point.objective;
    search.best.x = std::move(at);
  }
  for (unsigned i = 0; gradient != nullptr && i < n; ++i) gradient[i] = slope[i] / search.unit;
  return point.objective / search.unit;
}

// Refines one point. The optimiser may stop early, limited by round-off: the best point seen
// counts.
Refined refine(const Profile& profile, const std::vector<double>& start, const Progress& progress) {
  Search search{profile, 1.0, {start, profile.at(start).objective, Termination::kConverged}};
  search.unit = std::max(search.best.objective, 1e-300);
  std::vector<double> lower;
  std::vector<double> upper;
  for (const Profile::Coordinate& c : profile.coordinates()) {
    lower.push_back(c.lower());
    upper.push_back(c.upper());
  }
  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> optimiser(
      nlopt_create(NLOPT_LD_SLSQP, static_cast<unsigned>(start.size())), &nlopt_destroy);
  nlopt_set_lower_bounds(optimiser.get(), lower.data());
  nlopt_set_upper_bounds(optimiser.get(), upper.data());
  nlopt_set_ftol_rel(optimiser.get(), 1e-13);
  nlopt_set_xtol_rel(optimiser.get(), 1e-11);
  nlopt_set_maxeval(optimiser.get(), kMostEvaluations);
  nlopt_set_min_objective(optimiser.get(), &evaluate, &search);
  // A restart at the best point rebuilds the curvature; it ends the flat valleys that stop a first
  // run.
  for (int round = 0; round < 4 && !progress.stopped(); ++round) {
    const double before = search.best.objective;
    std::vector<double> x = search.best.x;
    double value = 0.0;
    const nlopt_result ended = nlopt_optimize(optimiser.get(), x.data(), &value);
    search.best.termination =
        ended == NLOPT_MAXEVAL_REACHED ? Termination::kEvaluations : Termination::kConverged;
    if (search.best.objective > before * (1.0 - 1e-12)) break;
  }
  return search.best;
}

Refined best_of(const Profile& profile, const std::vector<std::vector<double>>& starts,
                const Progress& progress) {
  std::vector<Refined> all(starts.size());
  for_each_index(starts.size(),
                 [&](std::size_t i) { all[i] = refine(profile, starts[i], progress); });
  return *std::min_element(all.begin(), all.end(), [](const Refined& a, const Refined& b) {
    return a.objective < b.objective;
  });
}

// The problem without one of its terms.
Problem without(const Problem& problem, std::size_t dropped) {
  Problem out = problem;
  out.model.terms.erase(out.model.terms.begin() + static_cast<std::ptrdiff_t>(dropped));
  for (MomentBlock& block : out.blocks) {
    for (Segment& segment : block.segments) {
      std::erase_if(segment.shares, [&](const Share& share) { return share.term == dropped; });
      for (Share& share : segment.shares) share.term -= share.term > dropped ? 1 : 0;
    }
  }
  return out;
}

// The best point known: from the scan, and from every smaller model (one open term less) plus that
// term, so that a larger model never ends worse than a smaller one.
Refined search(const Problem& problem, const Progress& progress) {
  const Profile profile(problem);
  std::vector<std::vector<double>> starts = starting_points(profile, kScanned);
  const std::vector<Term>& terms = problem.model.terms;
  for (std::size_t t = 0; t < terms.size() && !progress.stopped(); ++t) {
    const bool open = std::any_of(profile.coordinates().begin(), profile.coordinates().end(),
                                  [&](const auto& c) { return c.term == t; });
    const bool twin =
        t + 1 < terms.size() && terms[t] == terms[t + 1];  // drop one of equal terms only
    if (!open || twin) continue;
    const Problem smaller = without(problem, t);
    const Profile small_profile(smaller);
    if (small_profile.coordinates().empty()) continue;
    const Refined found = search(smaller, progress);
    std::vector<double> base(profile.coordinates().size(), 0.0);
    std::size_t next = 0;
    for (std::size_t i = 0; i < base.size(); ++i) {
      if (profile.coordinates()[i].term != t) base[i] = found.x[next++];
    }
    for (auto& start : starting_points(profile, kExtended, base, t))
      starts.push_back(std::move(start));
  }
  return best_of(profile, starts, progress);
}

}  // namespace

std::string_view describe(Termination termination) {
  switch (termination) {
    case Termination::kConverged:
      return "converged";
    case Termination::kEvaluations:
      return "stopped at the limit of evaluations; the best point seen is reported";
    case Termination::kLinear:
      return "solved exactly";
    case Termination::kStopped:
      break;
  }
  return "stopped";
}

namespace {

Minimum at_point(const Profile& profile, const Refined& found, const Progress& progress) {
  Profile::Point point = profile.at(found.x);
  return {std::move(point.model), std::move(point.matrix_powers), point.objective,
          progress.stopped() ? Termination::kStopped : found.termination};
}

Refined nothing_to_search() { return {{}, 0.0, Termination::kLinear}; }

}  // namespace

Minimum minimise(const Problem& problem, const Progress& progress) {
  const Profile profile(problem);
  const bool linear = profile.coordinates().empty();
  return at_point(profile, linear ? nothing_to_search() : search(problem, progress), progress);
}

Minimum minimise_from(const Problem& problem, std::span<const Model> starts,
                      const Progress& progress) {
  const Profile profile(problem);
  if (profile.coordinates().empty()) return at_point(profile, nothing_to_search(), progress);
  std::vector<std::vector<double>> points;
  for (const Model& start : starts) points.push_back(profile.coordinates_of(start));
  return at_point(profile, best_of(profile, points, progress), progress);
}

Minimum minimise_roughly(const Problem& problem, const Progress& progress) {
  const Profile profile(problem);
  if (profile.coordinates().empty()) return at_point(profile, nothing_to_search(), progress);
  return at_point(profile, refine(profile, starting_points(profile, 1).front(), progress),
                  progress);
}

}  // namespace imunoise
