#include "core/faults/clusters.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "core/support/distributions.h"
#include "core/support/random.h"

namespace imunoise {
namespace {

constexpr std::uint64_t kClusterSeed = 20261121;
constexpr int kClusterDraws = 1000;
constexpr int kClusterRounds = 3;

// P(|Z| > h), and its inverse.
double two_tails(double h) { return chi_square_tail(h * h, 1.0); }
double two_tailed(double probability) { return -normal_quantile(0.5 * probability); }

// E[1 / number of outputs beyond h that share samples with the first]: draws white noise that
// drives one output, each in turn, beyond h.
double mean_share(const Eigen::MatrixXd& filters, Eigen::Index dimension, double h) {
  const Eigen::Index length = filters.cols() / dimension;
  RandomStream random(kClusterSeed);
  std::uniform_real_distribution<double> uniform(1e-12, 1.0);
  Eigen::VectorXd noise(dimension * (3 * length - 2));
  const Eigen::Index centre = dimension * (length - 1);
  double sum = 0.0;
  for (int draw = 0; draw < kClusterDraws; ++draw) {
    for (double& x : noise) x = random.normal();
    const Eigen::Index driven = draw % filters.rows();
    const auto row = filters.row(driven);
    const double reached = two_tailed(two_tails(h) * uniform(random.engine()));
    auto window = noise.segment(centre, filters.cols());
    window += row.transpose() * (reached - row.dot(window));
    int beyond = 0;
    for (Eigen::Index shift = 0; shift + filters.cols() <= noise.size(); shift += dimension) {
      beyond += static_cast<int>(
          ((filters * noise.segment(shift, filters.cols())).array().abs() > h).count());
    }
    sum += 1.0 / std::max(1, beyond);
  }
  return sum / kClusterDraws;
}

}  // namespace

double cluster_threshold(const Eigen::MatrixXd& filters, Eigen::Index dimension, double rate) {
  const auto count = static_cast<double>(filters.rows());
  double h = two_tailed(std::min(0.5, rate / count));
  for (int round = 0; round < kClusterRounds; ++round) {
    h = two_tailed(std::min(0.5, rate / (count * mean_share(filters, dimension, h))));
  }
  return h;
}

}  // namespace imunoise
