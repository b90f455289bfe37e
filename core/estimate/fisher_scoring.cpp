#include "core/estimate/fisher_scoring.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/estimate/believed_information.h"
#include "core/support/linear_algebra.h"

namespace imunoise {
namespace {

constexpr double kLongestStep = 1.0;    // of a free coordinate
constexpr double kSmallestGain = 1e-7;  // nats: a few 1e-4 of a standard error
constexpr double kNear = 1.0;           // nats that a step gains: the top is near
constexpr double kFelt = 1.0;           // information of a free coordinate that is not lost
constexpr double kWalk = 2.0;           // step in search of it
constexpr double kFarthest = 32.0;      // a logit is at its end from anywhere

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
  Eigen::VectorXd out = at;
  out(inside) = powers;
  out(free) += inverse * (free_moment - across.transpose() * powers);
  return out;
}

// What the likelihood would gain along a way, were it as straight and as curved as here.
double foretold(const Curvature& curvature, const Eigen::VectorXd& way) {
  return curvature.score.dot(way) - 0.5 * way.dot(curvature.information * way);
}

// The way to there, no free coordinate farther than one step: cut one by one, or all by the same
// share, whichever is foretold more.
Eigen::VectorXd way_to(const Eigen::VectorXd& target, const Places& places,
                       const Curvature& curvature, const Eigen::VectorXd& at) {
  const Eigen::VectorXd whole = target - at;
  if (places.free.empty()) return whole;
  Eigen::VectorXd cut = whole;
  cut(places.free) = whole(places.free).cwiseMax(-kLongestStep).cwiseMin(kLongestStep);
  const double longest = whole(places.free).cwiseAbs().maxCoeff();
  const Eigen::VectorXd part = whole * std::min(1.0, kLongestStep / longest);
  return foretold(curvature, cut) > foretold(curvature, part) ? cut : part;
}

// How far steps are trusted: by how many times Fisher's information they are damped.
class Damping {
 public:
  double value() const { return value_; }
  void more() { value_ = std::max(kFirst, kFactor * value_); }
  /// After a step that gained this share of what was foretold.
  void learn(double share) {
    constexpr double kTooLittle = 0.25;
    constexpr double kEnough = 0.75;
    if (share < kTooLittle) more();
    if (share > kEnough) value_ = value_ > kFirst / kFactor ? value_ / kFactor : 0.0;
  }

 private:
  static constexpr double kFirst = 1.0;
  static constexpr double kFactor = 4.0;
  double value_ = 0.0;
};

// One step uphill, shorter and shorter until the likelihood grows. Returns by how much.
double step_up(const Likelihood& likelihood, const Places& places, bool near, Damping& damping,
               Scored& from) {
  Curvature here = likelihood.curvature(from.at, near ? Asked::kObserved : Asked::kFisher);
  const BelievedInformation believed(here.information, here.correction);
  for (;; damping.more()) {
    here.information = believed.damped(damping.value());
    const Eigen::VectorXd way = way_to(greatest(places, here, from.at), places, here, from.at);
    const double hope = foretold(here, way);
    if (!(hope >= kSmallestGain)) return 0.0;
    const Eigen::VectorXd next = from.at + way;
    const double objective = likelihood.objective(next);
    const double gain = from.objective - objective;
    if (!(gain > 0.0)) continue;
    damping.learn(gain / hope);
    from.at = next;
    from.objective = objective;
    return gain;
  }
}

// The start with one lost coordinate where it is felt, if there is such a place. That may take
// powers which suit it: a process whose power is zero is not felt anywhere.
Eigen::VectorXd found(const Likelihood& likelihood, const Places& places,
                      const Eigen::VectorXd& start, Eigen::Index coordinate) {
  for (double distance = kWalk; distance <= kFarthest; distance += kWalk) {
    for (const double side : {-distance, distance}) {
      Eigen::VectorXd out = start;
      out(coordinate) += side;
      const Curvature there = likelihood.curvature(out, Asked::kFisher);
      if (there.information(coordinate, coordinate) >= kFelt) return out;
      out(places.inside) = greatest(places, there, out)(places.inside);
      if (likelihood.curvature(out, Asked::kFisher).information(coordinate, coordinate) >= kFelt)
        return out;
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
  Damping damping;
  bool near = false;
  for (int step = 0; step < most_steps && out.termination == Termination::kEvaluations; ++step) {
    const double gain = step_up(likelihood, places, near, damping, out);
    if (!(gain >= kSmallestGain) && near) out.termination = Termination::kConverged;
    near = near || gain < kNear;
    if (progress.stopped()) out.termination = Termination::kStopped;
  }
  return out;
}

Scored maximise(const Likelihood& likelihood, const Eigen::VectorXd& start,
                const Progress& progress) {
  Scored out = fisher_scoring(likelihood, start, progress);
  if (!std::isfinite(out.objective) || out.termination == Termination::kStopped) return out;
  const Eigen::VectorXd felt = likelihood.curvature(start, Asked::kFisher).information.diagonal();
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
