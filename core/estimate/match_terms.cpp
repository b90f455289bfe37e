#include "core/estimate/match_terms.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace imunoise {
namespace {

constexpr std::size_t kMostMatched = 6;

using TermPlaces = std::vector<std::size_t>;

bool of_one_kind(const Term& a, const Term& b) {
  return a.process.index() == b.process.index() && a.given == b.given && a.sharing == b.sharing &&
         structure(a.process) == structure(b.process);
}

// The places of each kind of term that is there more than once.
std::vector<TermPlaces> kinds(const Model& model) {
  std::vector<TermPlaces> out;
  for (std::size_t t = 0; t < model.terms.size(); ++t) {
    const auto known = std::find_if(out.begin(), out.end(), [&](const TermPlaces& one) {
      return of_one_kind(model.terms[one.front()], model.terms[t]);
    });
    if (known == out.end()) {
      out.push_back({t});
    } else {
      known->push_back(t);
    }
  }
  std::erase_if(out, [](const TermPlaces& one) { return one.size() < 2; });
  return out;
}

// How far a term is from one of the reference.
Eigen::MatrixXd distances(const Model& model, const Model& reference, const TermPlaces& places,
                          HalfWidths m) {
  const Eigen::ArrayXd whole = variance(reference, m);
  const auto shares = [&](const Model& of, std::size_t t) {
    return Eigen::ArrayXd(variance(of.terms[t].process, m) / whole);
  };
  const auto n = static_cast<Eigen::Index>(places.size());
  Eigen::MatrixXd out(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      out(i, j) = (shares(model, places[static_cast<std::size_t>(i)]) -
                   shares(reference, places[static_cast<std::size_t>(j)]))
                      .square()
                      .sum();
    }
  }
  return out;
}

// Which row belongs to each column: the order of least sum.
std::vector<std::size_t> least(const Eigen::MatrixXd& distance) {
  std::vector<std::size_t> order(static_cast<std::size_t>(distance.rows()));
  std::iota(order.begin(), order.end(), 0);
  std::vector<std::size_t> best = order;
  double lowest = INFINITY;
  do {
    double sum = 0.0;
    for (std::size_t j = 0; j < order.size(); ++j)
      sum += distance(static_cast<Eigen::Index>(order[j]), static_cast<Eigen::Index>(j));
    if (!(sum < lowest)) continue;
    lowest = sum;
    best = order;
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

}  // namespace

Model matched(const Model& model, const Model& reference, HalfWidths m) {
  Model out = model;
  for (const TermPlaces& places : kinds(model)) {
    if (places.size() > kMostMatched) continue;
    const std::vector<std::size_t> order = least(distances(model, reference, places, m));
    for (std::size_t j = 0; j < places.size(); ++j)
      out.terms[places[j]] = model.terms[places[order[j]]];
  }
  return out;
}

bool has_equal_terms(const Model& model) { return !kinds(model).empty(); }

}  // namespace imunoise
