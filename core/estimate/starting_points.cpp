#include "core/estimate/starting_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/support/linear_algebra.h"

namespace imunoise {
namespace {

constexpr std::size_t kBeam =
    120;  // partial combinations kept while one term after another is added

// One trial of a nonlinear term's shape, with its column's place in the dictionary.
struct ShapeCandidate {
  std::vector<double> values;  // all parameters of the process, power 1
  Eigen::Index column;
};

Scales longest_scales(const Problem& problem) {
  Scales longest;
  for (const MomentBlock& block : problem.blocks) {
    for (const Segment& segment : block.segments) {
      if (longest.empty() || segment.scales.largest() > longest.largest()) {
        longest = segment.scales;
      }
    }
  }
  return longest;
}

// All trials of all nonlinear terms, and the Gram matrix of every column that can occur, so that a
// combination costs only a small non-negative least-squares problem.
class Dictionary {
 public:
  explicit Dictionary(const Profile& profile) : profile_(profile) {
    const Model& model = profile.problem().model;
    std::vector<Eigen::VectorXd> columns;
    for (std::size_t t = 0; t < model.terms.size(); ++t) {
      const bool open = is_open(t);
      std::vector<ShapeCandidate> trials;
      using Tried = std::vector<std::vector<double>>;
      for (const std::vector<double>& v :
           open ? scanned_values(t) : Tried{values(model.terms[t].process)}) {
        Process process = model.terms[t].process;
        set_values(process, v);
        trials.push_back({v, static_cast<Eigen::Index>(columns.size())});
        columns.push_back(profile.column({t, 0}, process));
      }
      trials_.push_back(std::move(trials));
    }
    target_ = profile.target(model);
    Eigen::MatrixXd all(target_.size(), static_cast<Eigen::Index>(columns.size()));
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const double norm = columns[i].norm();
      all.col(static_cast<Eigen::Index>(i)) =
          norm > 0.0 ? Eigen::VectorXd(columns[i] / norm) : columns[i];
    }
    gram_ = all.transpose() * all;
    moment_ = all.transpose() * target_;
  }

  const std::vector<ShapeCandidate>& trials(std::size_t term) const { return trials_[term]; }

  bool is_open(std::size_t term) const {
    return std::any_of(profile_.coordinates().begin(), profile_.coordinates().end(),
                       [&](const Profile::Coordinate& c) { return c.term == term; });
  }

  // Objective of a combination of trials (one a term; npos leaves the term out), up to a constant.
  double objective(const std::vector<std::size_t>& choice) const {
    std::vector<Eigen::Index> index;
    for (std::size_t t = 0; t < choice.size(); ++t) {
      const bool free = !profile_.problem().model.terms[t].given[0];
      if (choice[t] != kLeftOut && free) index.push_back(trials_[t][choice[t]].column);
    }
    const auto n = static_cast<Eigen::Index>(index.size());
    Eigen::MatrixXd g(n, n);
    Eigen::VectorXd c(n);
    for (Eigen::Index a = 0; a < n; ++a) {
      c(a) = moment_(index[static_cast<std::size_t>(a)]);
      for (Eigen::Index b = 0; b < n; ++b) {
        g(a, b) = gram_(index[static_cast<std::size_t>(a)], index[static_cast<std::size_t>(b)]);
      }
    }
    const Eigen::VectorXd beta = nonnegative_least_squares(g, c);
    return beta.dot(g * beta) - 2.0 * c.dot(beta);
  }

  static constexpr std::size_t kLeftOut = std::numeric_limits<std::size_t>::max();

 private:
  std::vector<std::vector<double>> scanned_values(std::size_t term) const {
    const Term& open = profile_.problem().model.terms[term];
    std::vector<std::vector<double>> out;
    for (const auto& shapes : scan(open.process, longest_scales(profile_.problem()))) {
      std::vector<double> v = values(open.process);
      for (std::size_t p = 1; p < v.size(); ++p) {
        if (!open.given[p]) v[p] = shapes[p - 1];
      }
      v[0] = open.given[0] ? v[0] : 1.0;
      if (std::find(out.begin(), out.end(), v) == out.end()) out.push_back(std::move(v));
    }
    return out;
  }

  const Profile& profile_;
  std::vector<std::vector<ShapeCandidate>> trials_;
  Eigen::MatrixXd gram_;
  Eigen::VectorXd moment_;
  Eigen::VectorXd target_;
};

struct Combination {
  std::vector<std::size_t> choice;
  double objective = 0.0;
};

void keep_best(std::vector<Combination>& all, std::size_t most) {
  std::stable_sort(all.begin(), all.end(), [](const Combination& a, const Combination& b) {
    return a.objective < b.objective;
  });
  if (all.size() > most) all.resize(most);
}

// Neighbours on the grid lead to the same minimum: keep only combinations that no kept one
// dominates nearby.
std::vector<Combination> distinct(const std::vector<Combination>& sorted, std::size_t most) {
  std::vector<Combination> out;
  for (const Combination& candidate : sorted) {
    const bool close = std::any_of(out.begin(), out.end(), [&](const Combination& kept) {
      for (std::size_t t = 0; t < kept.choice.size(); ++t) {
        const auto a = static_cast<std::ptrdiff_t>(kept.choice[t]);
        const auto b = static_cast<std::ptrdiff_t>(candidate.choice[t]);
        if (std::abs(a - b) > 2) return false;
      }
      return true;
    });
    if (!close) out.push_back(candidate);
    if (out.size() == most) break;
  }
  return out;
}

bool exchangeable(const Problem& problem, std::size_t a, std::size_t b) {
  if (!(problem.model.terms[a] == problem.model.terms[b])) return false;
  for (const MomentBlock& block : problem.blocks) {
    for (const Segment& segment : block.segments) {
      const auto has = [&](std::size_t t) {
        return std::find(segment.shares.begin(), segment.shares.end(), Share{t, 0}) !=
               segment.shares.end();
      };
      if (has(a) != has(b)) return false;
    }
  }
  return true;
}

std::vector<double> coordinates_of(const Profile& profile, const Dictionary& dictionary,
                                   const std::vector<std::size_t>& choice) {
  Model model = profile.problem().model;
  for (std::size_t t = 0; t < model.terms.size(); ++t) {
    set_values(model.terms[t].process, dictionary.trials(t)[choice[t]].values);
  }
  return profile.coordinates_of(model);
}

}  // namespace

std::vector<std::vector<double>> starting_points(const Profile& profile, std::size_t most) {
  const Problem& problem = profile.problem();
  const Dictionary dictionary(profile);
  const std::size_t terms = problem.model.terms.size();
  Combination empty;
  empty.choice.resize(terms, 0);
  std::vector<std::size_t> open;
  for (std::size_t t = 0; t < terms; ++t) {
    if (!dictionary.is_open(t)) continue;
    open.push_back(t);
    empty.choice[t] = Dictionary::kLeftOut;
  }
  std::vector<Combination> beam = {empty};
  for (std::size_t i = 0; i < open.size(); ++i) {
    const std::size_t t = open[i];
    std::vector<Combination> longer;
    for (const Combination& partial : beam) {
      // Equal terms are interchangeable: take their trials in ascending order only.
      const bool twin = i > 0 && exchangeable(problem, open[i - 1], t);
      for (std::size_t k = twin ? partial.choice[open[i - 1]] : 0; k < dictionary.trials(t).size();
           ++k) {
        Combination next = partial;
        next.choice[t] = k;
        next.objective = dictionary.objective(next.choice);
        longer.push_back(std::move(next));
      }
    }
    keep_best(longer, i + 1 < open.size() ? kBeam : longer.size());
    beam = std::move(longer);
  }
  std::vector<std::vector<double>> out;
  for (const Combination& c : distinct(beam, most)) {
    out.push_back(coordinates_of(profile, dictionary, c.choice));
  }
  return out;
}

std::vector<std::vector<double>> starting_points(const Profile& profile, std::size_t most,
                                                 const std::vector<double>& base,
                                                 std::size_t added) {
  const Problem& problem = profile.problem();
  struct Scored {
    double objective;
    std::vector<double> x;
  };
  std::vector<Scored> all;
  for (const auto& shapes : scan(problem.model.terms[added].process, longest_scales(problem))) {
    std::vector<double> x = base;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Profile::Coordinate& c = profile.coordinates()[i];
      if (c.term == added) x[i] = c.slope ? 0.0 : c.to_search(shapes[c.parameter - 1]);
    }
    all.push_back({profile.at(x).objective, std::move(x)});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Scored& a, const Scored& b) { return a.objective < b.objective; });
  std::vector<std::vector<double>> out;
  for (std::size_t i = 0; i < std::min(most, all.size()); ++i) out.push_back(std::move(all[i].x));
  return out;
}

}  // namespace imunoise
