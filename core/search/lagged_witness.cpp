#include "core/search/lagged_witness.h"

#include <algorithm>
#include <cmath>

#include "core/effect/filters.h"

namespace imunoise {

LaggedWitness::LaggedWitness(const SlowView& view, const Subject& subject, const Witness& witness) {
  double longest = 0.0;
  for (std::size_t k = 0; k < subject.replicates(); ++k) {
    means_.push_back(view.means(witness.samples[k], k));
    block_s_.push_back(view.block_seconds(k));
    longest = std::max(longest, subject.seconds(k));
  }
  shortest_ = std::max(4.0 * view.longest_block_seconds(), 2e-4 * longest);
  longest_ = 0.25 * longest;
}

SlowView::Means LaggedWitness::late(double lag_s) const {
  SlowView::Means out;
  for (std::size_t k = 0; k < means_.size(); ++k)
    out.push_back(lagged(means_[k], lag_s / block_s_[k]));
  return out;
}

SlowView::Means LaggedWitness::early(double lag_s) const {
  SlowView::Means out;
  for (std::size_t k = 0; k < means_.size(); ++k)
    out.push_back(lagged(means_[k].reverse(), lag_s / block_s_[k]).reverse());
  return out;
}

}  // namespace imunoise
