#pragma once

#include <string>
#include <vector>

#include "core/diagnosis/slow_view.h"

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
  double block_s_;
  double shortest_;
  double longest_;
};

/// What a witness would explain behind each lag.
struct LagCurve {
  std::string witness;
  std::vector<double> seconds;  ///< rising; negative: the witness comes after its effect
  std::vector<double> nats;     ///< log-likelihood gained there, to first order
  double chance = 0.0;          ///< nats that the best lag gains by chance once in twenty
};

/// A curve for each witness of a subject long enough for lags.
std::vector<LagCurve> lag_curves(const Current& current);

}  // namespace imunoise
