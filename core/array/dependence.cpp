#include "core/array/dependence.h"

#include <algorithm>

#include "core/array/array_blocks.h"
#include "core/support/holm.h"
#include "core/support/linear_algebra.h"
#include "core/wavelet/wavelet_variance.h"

namespace imunoise {
namespace {

constexpr double kLeastDegrees = 10.0;

ArrayModel without_correlation(ArrayModel model) {
  for (Latent& latent : model.latents) {
    const Eigen::VectorXd own = latent.power.diagonal();
    latent.power = own.asDiagonal();
  }
  return model;
}

void adjust(std::vector<PairDependence>& tests) {
  std::vector<double> p_values;
  for (const PairDependence& one : tests) p_values.push_back(one.test.p_value);
  const std::vector<double> adjusted = holm(p_values);
  for (std::size_t i = 0; i < tests.size(); ++i) tests[i].adjusted_p = adjusted[i];
}

// What replicates of one length say about one pair, by their share in the mean over all.
struct GroupOfPair {
  Eigen::ArrayXd cross;
  Eigen::ArrayXd own_a;
  Eigen::ArrayXd own_b;
  Eigen::MatrixXd covariance;  // of `cross`, under independence
};

// The scales of some replicates with enough degrees of freedom, and the share of each in the mean
// over all replicates.
struct TestedGroup {
  const ReplicateGroup* group;
  Scales scales;
  Eigen::ArrayXd share;
};

Scales tested_scales(const ReplicateGroup& group) {
  const Eigen::ArrayXd degrees = equivalent_degrees(group.scales, group.samples);
  std::vector<bool> used;
  for (const double d : degrees) used.push_back(d >= kLeastDegrees);
  return group.scales.where(used);
}

// Shares by equivalent degrees of freedom. Scales of shorter replicates are the first of those of
// longer ones.
std::vector<TestedGroup> tested_groups(const std::vector<ReplicateGroup>& groups) {
  std::vector<TestedGroup> out;
  Eigen::ArrayXd total = Eigen::ArrayXd::Zero(0);
  for (const ReplicateGroup& group : groups) {
    const Scales scales = tested_scales(group);
    const Eigen::ArrayXd degrees = group.count * equivalent_degrees(scales, group.samples);
    if (degrees.size() > total.size()) {
      const Eigen::Index known = total.size();
      total.conservativeResize(degrees.size());
      total.tail(degrees.size() - known).setZero();
    }
    total.head(degrees.size()) += degrees;
    out.push_back({&group, scales, degrees});
  }
  for (TestedGroup& one : out) one.share /= total.head(one.share.size());
  return out;
}

GroupOfPair group_of_pair(const ArrayModel& independent, const TestedGroup& tested,
                          const Pair& pair) {
  const Eigen::Index n = tested.share.size();
  const auto mean = [&](Eigen::Index a, Eigen::Index b) {
    Eigen::ArrayXd out(n);
    for (Eigen::Index j = 0; j < n; ++j)
      out(j) = tested.group->mean[static_cast<std::size_t>(j)](a, b);
    return Eigen::ArrayXd(tested.share * out);
  };
  const Eigen::MatrixXd weight = tested.share.matrix().asDiagonal();
  return {mean(pair.a, pair.b), mean(pair.a, pair.a), mean(pair.b, pair.b),
          weight *
              array_moment_covariance(independent, {pair}, tested.scales, tested.group->samples) *
              weight / tested.group->count};
}

}  // namespace

std::vector<PairDependence> dependence(const ArrayModel& model,
                                       std::span<const WaveletCovariance> replicates) {
  const ArrayModel independent = without_correlation(model);
  const std::vector<ReplicateGroup> groups = groups_of(replicates);
  const std::vector<TestedGroup> tested = tested_groups(groups);
  Eigen::Index n = 0;
  for (const TestedGroup& one : tested) n = std::max(n, one.share.size());
  std::vector<PairDependence> out;
  for (const Pair& pair : all_pairs(model.sensors)) {
    if (pair.a == pair.b) continue;
    PairDependence one{pair, {}, 1.0, Eigen::ArrayXd::Zero(n), Eigen::ArrayXd::Zero(n)};
    if (n == 0) {  // too short to tell
      out.push_back(std::move(one));
      continue;
    }
    GroupOfPair all{one.z, one.z, one.z, Eigen::MatrixXd::Zero(n, n)};
    for (const TestedGroup& group : tested) {
      const Eigen::Index size = group.share.size();
      if (size == 0) continue;
      const GroupOfPair part = group_of_pair(independent, group, pair);
      all.cross.head(size) += part.cross;
      all.own_a.head(size) += part.own_a;
      all.own_b.head(size) += part.own_b;
      all.covariance.topLeftCorner(size, size) += part.covariance;
    }
    const Eigen::VectorXd whitened = whiten(all.covariance).matrix * all.cross.matrix();
    one.test = chi_square_test(whitened.squaredNorm(), whitened.size());
    one.z = all.cross / all.covariance.diagonal().array().sqrt();
    one.correlation = all.cross / (all.own_a * all.own_b).sqrt();
    out.push_back(std::move(one));
  }
  adjust(out);
  return out;
}

}  // namespace imunoise
