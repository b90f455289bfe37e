#pragma once

// A few samples among many are disturbed: a mixture of two normal distributions.

#include <Eigen/Core>
#include <optional>

namespace imunoise {

/// Deviations of which a share is `width` times as wide as the others, whose standard deviation is
/// 1 (Tukey 1960: contaminated normal distribution).
struct Contamination {
  double share = 0.0;
  double width = 1.0;

  /// Logarithm of its density over that of a standard normal number, at a deviation z.
  double log_ratio(double z) const;
  /// The deviation that is as likely one of the wider ones as not.
  double even_chance() const;
};

/// The most likely one where `count` ≥ 1 of `samples` deviations have |z| > above, with the mean of
/// z² there; absent where these are no wider than normal ones.
std::optional<Contamination> contamination_of(double count, double samples, double above,
                                              double mean_square);

}  // namespace imunoise
