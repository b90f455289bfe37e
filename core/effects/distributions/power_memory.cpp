#include "core/effects/distributions/power_memory.h"

#include <algorithm>
#include <cmath>

#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr int kMostOctaves = 40;
using Octaves = Eigen::Array<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostOctaves, 1>;

// Of one replicate, or some together.
struct Score {
  Octaves sum;       // of products,
  Octaves weights;   // and of the squares of their weights
  Octaves variance;  // of the sum, were the power constant
};

// Of squares, less their mean. Those of more than three standard deviations count as such: an
// outlier remembers nothing.
Score score_of(const Eigen::VectorXd& white, const Octaves& stays) {
  constexpr double kLargest = 9.0;  // mean squares
  const Octaves none = Octaves::Zero(stays.size());
  Score out{none, none, none};
  const auto n = static_cast<double>(white.size());
  const double square = white.squaredNorm() / n;
  if (!(square > 0.0)) return out;
  const Eigen::ArrayXd capped = (white.array().square() / square).min(kLargest);
  const Eigen::ArrayXd above = capped - capped.mean();
  Octaves past = none;
  for (const double one : above) {
    out.sum += one * past;
    past = stays * (past + one);
  }
  const Octaves q = stays.square();
  const double scatter = above.square().mean();
  out.weights = n * q / (1.0 - q) - q * (1.0 - q.pow(n)) / (1.0 - q).square();
  out.variance = scatter * scatter * out.weights;
  return out;
}

}  // namespace

std::vector<PowerMemory> power_memory(const Innovations& innovations) {
  Index longest = 0;
  for (const Eigen::VectorXd& white : innovations.white) longest = std::max(longest, white.size());
  Octaves tau(kMostOctaves);
  Index octaves = 0;
  for (double one = 2.0; one <= static_cast<double>(longest) && octaves < kMostOctaves; one *= 2.0)
    tau(octaves++) = one;
  if (octaves == 0) return {};
  tau.conservativeResize(octaves);
  const Octaves stays = (-1.0 / tau).exp();
  std::vector<Score> scores(innovations.white.size());
  for_each_index(scores.size(),
                 [&](std::size_t k) { scores[k] = score_of(innovations.white[k], stays); });
  const Octaves none = Octaves::Zero(octaves);
  Score all{none, none, none};
  for (const Score& one : scores) {
    all.sum += one.sum;
    all.weights += one.weights;
    all.variance += one.variance;
  }
  std::vector<PowerMemory> out;
  for (Index i = 0; i < octaves; ++i) {
    // The power cannot be less alike than not at all.
    if (!(all.sum(i) > 0.0 && all.variance(i) > 0.0)) continue;
    const double deviations = all.sum(i) / std::sqrt(all.variance(i));
    out.push_back({tau(i), 0.5 * deviations * deviations, all.sum(i) / all.weights(i)});
  }
  return out;
}

}  // namespace imunoise
