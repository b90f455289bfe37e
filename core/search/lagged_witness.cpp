#include "core/search/lagged_witness.h"

#include <algorithm>
#include <cmath>

#include "core/effect/filters.h"

namespace imunoise {

LaggedWitness::LaggedWitness(const SlowView& view, const Subject& subject, const Witness& witness)
    : block_s_(static_cast<double>(view.block(0)) / subject.rate.value),
      shortest_(std::max(4.0 * block_s_, 2e-4 * subject.seconds(0))),
      longest_(0.25 * subject.seconds(0)) {
  for (std::size_t k = 0; k < subject.replicates(); ++k)
    means_.push_back(view.means(witness.samples[k], k));
}

SlowView::Means LaggedWitness::late(double lag_s) const {
  SlowView::Means out;
  for (const Eigen::VectorXd& x : means_) out.push_back(lagged(x, lag_s / block_s_));
  return out;
}

SlowView::Means LaggedWitness::early(double lag_s) const {
  SlowView::Means out;
  for (const Eigen::VectorXd& x : means_)
    out.push_back(lagged(x.reverse(), lag_s / block_s_).reverse());
  return out;
}

}  // namespace imunoise
