#include "core/faults/step_watch.h"

#include <algorithm>
#include <cmath>

#include "core/faults/clusters.h"
#include "core/support/distributions.h"

namespace imunoise {
namespace {

// The threshold of z that chance exceeds as often, where its variance is known with so many degrees
// of freedom.
double as_known(double threshold, double degrees) {
  if (!std::isfinite(degrees)) return threshold;
  return -student_quantile(normal_tail(threshold), degrees);
}

}  // namespace

StepWatch::StepWatch(const ArrayModel& model, const ModelDoubt& doubt,
                     const std::vector<Eigen::Index>& used, std::int64_t block,
                     Eigen::Index fewest_blocks, double false_alarms)
    : block_(block),
      fewest_blocks_(fewest_blocks),
      stream_(InnovationFilter(model, parity_rows(model.sensors, used), block)) {
  const InnovationFilter& filter = stream_.filter();
  const Eigen::Index r = filter.outputs();
  const Eigen::Index ages = kMostBlocks - fewest_blocks + 1;
  const auto count = static_cast<Eigen::Index>(used.size());
  matched_ = Eigen::MatrixXd::Zero(count * ages, r * kMostBlocks);
  norms_.resize(count * ages);
  recent_ = Eigen::VectorXd::Zero(r * kMostBlocks);
  z_ = Eigen::VectorXd::Zero(count * ages);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::MatrixXd response =
        filter.step_response(used[static_cast<std::size_t>(i)], kMostBlocks);
    for (Eigen::Index a = 0; a < ages; ++a) {
      const Eigen::Index age = fewest_blocks + a;
      const Eigen::Index row = i * ages + a;
      norms_(row) = response.leftCols(age).norm();
      for (Eigen::Index j = 0; j < age; ++j) {  // the newest innovation saw the oldest response
        matched_.block(row, r * (age - 1 - j), 1, r) = response.col(j).transpose() / norms_(row);
      }
    }
  }
  threshold_ =
      as_known(cluster_threshold(matched_, r, false_alarms), doubt.degrees(filter, matched_));
}

bool StepWatch::feed(const Eigen::Ref<const Eigen::VectorXd>& parity) {
  if (!stream_.feed(parity)) return false;
  const Eigen::Index r = stream_.filter().outputs();
  std::copy_backward(recent_.begin(), recent_.end() - r, recent_.end());
  recent_.head(r) = stream_.innovation();
  if (++seen_ < kMostBlocks) return false;
  z_.noalias() = matched_ * recent_;
  return z_.cwiseAbs().maxCoeff() > threshold_;
}

StepEvidence StepWatch::strongest(Eigen::Index index) const {
  const Eigen::Index ages = kMostBlocks - fewest_blocks_ + 1;
  Eigen::Index best = 0;
  z_.segment(index * ages, ages).cwiseAbs().maxCoeff(&best);
  const Eigen::Index row = index * ages + best;
  return {z_(row), z_(row) / norms_(row), 1.0 / norms_(row), fewest_blocks_ + best};
}

}  // namespace imunoise
