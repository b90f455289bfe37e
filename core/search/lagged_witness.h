#pragma once

#include "core/search/slow_view.h"

namespace imunoise {

/// A witness as the slow view sees it, behind or ahead of itself by a first-order lag.
class LaggedWitness {
 public:
  LaggedWitness(const SlowView& view, const Subject& subject, const Witness& witness);

  SlowView::Means late(double lag_s) const;
  SlowView::Means early(double lag_s) const;
  /// The lags worth a try, in s; none where shortest() is not below longest().
  double shortest() const { return shortest_; }
  double longest() const { return longest_; }

 private:
  SlowView::Means means_;
  std::vector<double> block_s_;  // of each replicate
  double shortest_;
  double longest_;
};

}  // namespace imunoise
