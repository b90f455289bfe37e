#pragma once

#include <map>
#include <span>
#include <vector>

#include "core/array/array_moments.h"
#include "core/wavelet/wavelet_covariance.h"
#include "core/wavelet/wavelet_variance.h"

namespace imunoise {

/// The wavelet variance of one sensor of an array.
WaveletVariance own_variance(const WaveletCovariance& measured, Eigen::Index sensor);

/// Replicates of one length, and the average of their cross-covariances.
struct ReplicateGroup {
  Scales scales;
  std::size_t samples;
  double count;
  std::vector<Eigen::MatrixXd> mean;
};
std::vector<ReplicateGroup> groups_of(std::span<const WaveletCovariance> replicates);

/// Moments that are weighted together. Borrows its group.
struct ArrayBlock {
  const ReplicateGroup* group;
  Pairs pairs;
};

/// All pairs of a group together while they have at most 1,200 moments, else each by itself.
std::vector<ArrayBlock> blocks_of(const std::vector<ReplicateGroup>& groups, const Pairs& pairs);

/// Weights without a model: the inverse of (ν_aa ν_bb + ν_ab²) / (M/2m), on the diagonal of the
/// variance of the peers' χ² intervals. Ω = rootᵀ·root.
Eigen::MatrixXd diagonal_root(const ArrayBlock& block);

/// Exact covariances of the blocks' averaged moments under models that differ in their powers
/// alone. Borrows the blocks' groups.
class BlockCovariance {
 public:
  BlockCovariance(const ArrayModel& shapes, const std::vector<ArrayBlock>& blocks);

  Eigen::MatrixXd operator()(const ArrayModel& model, const ArrayBlock& block) const;

 private:
  std::map<const ReplicateGroup*, ArrayMomentCovariance> groups_;
};

}  // namespace imunoise
