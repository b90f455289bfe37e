#include "core/search/shape_spread.h"

#include <algorithm>
#include <vector>

#include "core/spectrum/cosine_transform.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr Index kQuarters = 4;
constexpr Index kFewest = 16;  // coefficients of an octave
constexpr double kBeyondChance = 3.0;

// One replicate: octaves, the highest first.
struct Shapes {
  Eigen::ArrayXd mean;      // of its quarters: logarithm of the octave's power over that of all
  Eigen::ArrayXd scatter;   // of its quarters: sum of squares about it
  Eigen::ArrayXd variance;  // that chance alone gives a quarter
};

Shapes shapes_of(const Eigen::VectorXd& white) {
  const auto n =
      static_cast<Index>(quick_length(static_cast<std::size_t>(white.size() / kQuarters)));
  std::vector<Index> edges{n - 1};
  while (edges.back() - edges.back() / 2 >= kFewest) edges.push_back(edges.back() / 2);
  const auto octaves = static_cast<Index>(edges.size()) - 1;
  if (octaves < 1) return {};
  Eigen::ArrayXXd logarithm(octaves, kQuarters);
  Shapes out;
  out.variance.resize(octaves);
  for (Index q = 0; q < kQuarters; ++q) {
    const Eigen::ArrayXd power =
        cosine_transform(white.segment(q * (white.size() / kQuarters), n)).array().square();
    const double all = std::log(power.mean());
    for (Index o = 0; o < octaves; ++o) {
      const Index begin = edges[static_cast<std::size_t>(o) + 1];
      const Index width = edges[static_cast<std::size_t>(o)] - begin;
      logarithm(o, q) = std::log(power.segment(begin, width).mean()) - all;
      out.variance(o) = 2.0 / static_cast<double>(width) - 2.0 / static_cast<double>(n - 1);
    }
  }
  out.mean = logarithm.rowwise().mean();
  out.scatter = (logarithm.colwise() - out.mean).square().rowwise().sum();
  return out;
}

}  // namespace

ShapeSpread shape_spread(const Innovations& innovations) {
  std::vector<Shapes> all(innovations.white.size());
  for_each_index(all.size(), [&](std::size_t i) { all[i] = shapes_of(innovations.white[i]); });
  Index octaves = all.empty() ? 0 : all.front().mean.size();
  for (const Shapes& one : all) octaves = std::min(octaves, one.mean.size());
  const double within_dof = static_cast<double>(all.size()) * (kQuarters - 1.0);
  double differs = 0.0;  // how much, over chance, in all octaves,
  double counts = 0.0;   // and as it counts
  bool steady = true;
  for (Index o = 0; o < octaves; ++o) {
    double weight = 0.0;
    double sum = 0.0;
    double within = 0.0;
    for (const Shapes& one : all) {
      weight += kQuarters / one.variance(o);
      sum += kQuarters / one.variance(o) * one.mean(o);
      within += one.scatter(o) / one.variance(o) / within_dof;
    }
    double between = 0.0;
    for (const Shapes& one : all) {
      const double from_mean = one.mean(o) - sum / weight;
      between += kQuarters / one.variance(o) * from_mean * from_mean;
    }
    const bool chance = within < 1.0 + kBeyondChance * std::sqrt(2.0 / within_dof);
    steady = steady && chance;
    differs += between;
    counts += chance ? between : between / within;
  }
  if (steady || !(counts > 0.0)) return {};
  return {differs / counts, within_dof};
}

double level_gain(const Innovations& innovations) {
  double squares = 0.0;
  double count = 0.0;
  for (const Eigen::VectorXd& one : innovations.white) {
    squares += one.squaredNorm();
    count += static_cast<double>(one.size());
  }
  double out = 0.0;
  for (const Eigen::VectorXd& one : innovations.white) {
    const auto n = static_cast<double>(one.size());
    const double ratio = one.squaredNorm() / n / (squares / count);
    out -= 0.5 * n * std::log(ratio);
  }
  return out;
}

}  // namespace imunoise
