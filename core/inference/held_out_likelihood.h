#pragma once

// Models compared by Whittle's likelihood of data that they were not fitted to.

#include <span>
#include <vector>

#include "core/estimate/whittle.h"

namespace imunoise {

/// How well a model predicts each part of the data when it is fitted to the others.
struct HeldOutFit {
  Model model;  ///< fitted to all parts
  std::vector<double>
      nats;  ///< log-likelihood of each part, less what does not depend on the model

  double total() const;
};

/// Fits a model, whose values are all set, to all parts but one and takes the likelihood of that
/// one: each part in its turn. At least two parts, all of one rate.
HeldOutFit held_out_fit(const Model& start, std::span<const BandedPower> parts);

/// The bands of one replicate dealt out in turn. Coefficients of the cosine transform are
/// independent, so that each part is data of its own, and every part has all frequencies: the
/// slowest, too, which blocks of time would lose.
std::vector<BandedPower> dealt_out(const BandedPower& whole, std::size_t parts);

/// Held-out likelihoods that differ by less do not tell a model from a larger one: a model that is
/// true is beaten by another by 3 nats with a probability of at most e⁻³ = 5 % (Markov's inequality
/// for likelihood ratios of data to come).
inline constexpr double kClearNats = 3.0;

/// The number of the simplest fit within kClearNats of the best; of equals, the better one.
/// Precondition: at least one.
std::size_t simplest_of_best(std::span<const HeldOutFit> fits);

}  // namespace imunoise
