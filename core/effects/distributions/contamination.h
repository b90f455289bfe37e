#pragma once

// A few samples among many are disturbed: a mixture of two normal distributions.

#include <Eigen/Core>
#include <optional>

namespace imunoise {

/// A contaminated normal distribution (Tukey 1960): most deviations have the standard deviation 1,
/// a share of them has `width`.
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
