#include "core/estimate/fisher_scoring.h"

#include <cassert>
#include <cmath>

#include "core/support/linear_algebra.h"

namespace imunoise {
namespace {

constexpr double kLongestStep = 1.0;     // of a free coordinate
constexpr double kSmallestShare = 1e-6;  // of a step
constexpr double kSmallestGain = 1e-7;   // nats: a few 1e-4 of a standard error
constexpr double kFelt = 1.0;            // information of a free coordinate that is not lost
constexpr double kWalk = 2.0;            // step in search of it
constexpr double kFarthest = 32.0;       // a logit is at its end from anywhere

// Which coordinates lie in cones, and the cones' sizes; the others are free.
struct Places {
  explicit Places(const std::vector<Eigen::Index>& given) {
    for (const Eigen::Index size : given) {
      if (size == Likelihood::kFree) {
        free.push_back(coordinates++);
        continue;
      }
      sizes.push_back(size);
      for (Eigen::Index i = 0; i < packed_size(size); ++i) inside.push_back(coordinates++);
    }
  }

  std::vector<Eigen::Index> inside;
  std::vector<Eigen::Index> free;
  std::vector<Eigen::Index> sizes;
  Eigen::Index coordinates = 0;
};

// Where the linearised likelihood is greatest. The steps of the free coordinates follow from what
// is in the cones, which is solved for by itself.
Eigen::VectorXd greatest(const Places& places, const Curvature& curvature,
                         const Eigen::VectorXd& at) {
  const auto& [inside, free, sizes, count] = places;
  const Eigen::MatrixXd& information = curvature.information;
  const Eigen::MatrixXd within = information(inside, inside);
  const Eigen::MatrixXd across = information(inside, free);
  const Eigen::MatrixXd inverse = pseudo_inverse(information(free, free)).matrix;
  // For q in the cones and steps d: maximal in score·(q - at, d) less half its length².
  const Eigen::VectorXd moment = curvature.score(inside) + within * at(inside);
  const Eigen::VectorXd free_moment = curvature.score(free) + across.transpose() * at(inside);
  const Eigen::VectorXd powers =
      conic_least_squares(within - across * inverse * across.transpose(),
                          moment - across * inverse * free_moment, sizes);
  const Eigen::VectorXd steps = inverse * (free_moment - across.transpose() * powers);
  Eigen::VectorXd out = at;
  out(inside) = powers;
  out(free) += steps.cwiseMax(-kLongestStep).cwiseMin(kLongestStep);
  return out;
}

// The start with one lost coordinate where it is felt, if there is such a place. That may take
// powers which suit it: a process whose power is zero is not felt anywhere.
Eigen::VectorXd found(const Likelihood& likelihood, const Places& places,
                      const Eigen::VectorXd& start, Eigen::Index coordinate) {
  for (double distance = kWalk; distance <= kFarthest; distance += kWalk) {
    for (const double side : {-distance, distance}) {
      Eigen::VectorXd out = start;
      out(coordinate) += side;
      const Curvature there = likelihood.curvature(out);
      if (there.information(coordinate, coordinate) >= kFelt) return out;
      out(places.inside) = greatest(places, there, out)(places.inside);
      if (likelihood.curvature(out).information(coordinate, coordinate) >= kFelt) return out;
    }
  }
  return start;
}

}  // namespace

Scored fisher_scoring(const Likelihood& likelihood, const Eigen::VectorXd& start,
                      const Progress& progress, int most_steps) {
  const Places places(likelihood.cones);
  assert(start.size() == places.coordinates);
  Scored out{start, likelihood.objective(start), Termination::kEvaluations};
  if (!std::isfinite(out.objective)) return out;
  for (int step = 0; step < most_steps && out.termination == Termination::kEvaluations; ++step) {
    const Eigen::VectorXd target = greatest(places, likelihood.curvature(out.at), out.at);
    double gain = 0.0;
    for (double share = 1.0; share > kSmallestShare && !(gain > 0.0); share *= 0.5) {
      const Eigen::VectorXd next = out.at + share * (target - out.at);
      const double objective = likelihood.objective(next);
      gain = out.objective - objective;
      if (gain > 0.0) {
        out.at = next;
        out.objective = objective;
      }
    }
    if (!(gain >= kSmallestGain)) out.termination = Termination::kConverged;
    if (progress.stopped()) out.termination = Termination::kStopped;
  }
  return out;
}

Scored maximise(const Likelihood& likelihood, const Eigen::VectorXd& start,
                const Progress& progress) {
  Scored out = fisher_scoring(likelihood, start, progress);
  if (!std::isfinite(out.objective) || out.termination == Termination::kStopped) return out;
  const Eigen::VectorXd felt = likelihood.curvature(start).information.diagonal();
  Eigen::VectorXd moved = start;
  const Places places(likelihood.cones);
  for (const Eigen::Index i : places.free) {
    if (felt(i) < kFelt) moved = found(likelihood, places, moved, i);
  }
  if (moved == start) return out;
  Scored other = fisher_scoring(likelihood, moved, progress);
  return other.objective < out.objective ? other : out;
}

}  // namespace imunoise
