#include "core/array/array_blocks.h"

#include <algorithm>
#include <cmath>

namespace imunoise {
namespace {

constexpr Eigen::Index kMostJoint = 1200;

}  // namespace

WaveletVariance own_variance(const WaveletCovariance& measured, Eigen::Index sensor) {
  WaveletVariance out;
  out.scales = measured.scales;
  out.variance = measured.of(sensor, sensor);
  out.samples = measured.samples;
  out.rate = measured.rate;
  out.quantity = measured.quantity;
  set_chi_square_interval(out);
  return out;
}

std::vector<ReplicateGroup> groups_of(std::span<const WaveletCovariance> replicates) {
  std::vector<ReplicateGroup> out;
  for (const WaveletCovariance& one : replicates) {
    const auto found = std::find_if(out.begin(), out.end(), [&](const ReplicateGroup& group) {
      return group.samples == one.samples && group.scales == one.scales;
    });
    if (found == out.end()) {
      out.push_back({one.scales, one.samples, 1.0, one.covariance});
      continue;
    }
    found->count += 1.0;
    for (std::size_t j = 0; j < found->mean.size(); ++j) {
      found->mean[j] += (one.covariance[j] - found->mean[j]) / found->count;
    }
  }
  return out;
}

std::vector<ArrayBlock> blocks_of(const std::vector<ReplicateGroup>& groups, const Pairs& pairs) {
  std::vector<ArrayBlock> out;
  for (const ReplicateGroup& group : groups) {
    if (static_cast<Eigen::Index>(group.scales.size() * pairs.size()) <= kMostJoint) {
      out.push_back({&group, pairs});
    } else {
      for (const Pair& pair : pairs) out.push_back({&group, {pair}});
    }
  }
  return out;
}

Eigen::MatrixXd diagonal_root(const ArrayBlock& block) {
  const Eigen::ArrayXd degrees = equivalent_degrees(block.group->scales, block.group->samples);
  const auto n = degrees.size();
  Eigen::VectorXd out(n * static_cast<Eigen::Index>(block.pairs.size()));
  Eigen::Index at = 0;
  for (const auto& [a, b] : block.pairs) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const Eigen::MatrixXd& c = block.group->mean[static_cast<std::size_t>(j)];
      const double variance = (c(a, a) * c(b, b) + c(a, b) * c(a, b)) / degrees(j);
      out(at++) = variance > 0.0 ? std::sqrt(block.group->count / variance) : 0.0;
    }
  }
  return out.asDiagonal();
}

BlockCovariance::BlockCovariance(const ArrayModel& shapes, const std::vector<ArrayBlock>& blocks) {
  for (const ArrayBlock& block : blocks)
    groups_.try_emplace(block.group, shapes, block.group->scales, block.group->samples);
}

Eigen::MatrixXd BlockCovariance::operator()(const ArrayModel& model,
                                            const ArrayBlock& block) const {
  return groups_.at(block.group)(model, block.pairs) / block.group->count;
}

}  // namespace imunoise
