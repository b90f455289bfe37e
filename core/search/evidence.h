#pragma once

// How much a candidate explains, in one currency, whatever it is and wherever it was sought.

#include <Eigen/Core>
#include <vector>

namespace imunoise {

/// Where a search looked for an effect: the more places, the better the best of them looks by
/// chance.
struct Search {
  /// Length of the path of whitened unit scores over a scanned shape (Davies 1987): the sum of the
  /// angles between neighbours, rad. 0 where nothing was scanned.
  double path = 0.0;
  /// Logarithm of how many separate places were tried besides: 0 for one.
  double log_places = 0.0;
};

/// Logarithm of the p-value of an effect of `dof` coefficients that gains this many nats of
/// likelihood at a given place; -∞ of an infinite gain, over a model under which the data are
/// impossible. `noise_dof`: degrees of freedom behind the noise level where the effect is
/// (infinite: known). One-sided for a power, which cannot be negative.
double log_p_value(double gain_nats, double dof, double noise_dof, bool power);

/// The same for the best place of a search, at most 0.
double log_p_value(double gain_nats, double dof, double noise_dof, bool power,
                   const Search& search);

/// Nats that the best place of a search must gain for its p-value to be `level`, the noise known.
double gain_needed(double level, double dof, bool power, const Search& search);

/// What a search pays for having chosen how many (samples, jumps) it needs, nats: log n(n + 1), by
/// chances 1/(n(n + 1)) of each number, which add up to 1. 0 for none.
double log_number(double count);

/// The length of the path along the columns of a matrix (unit vectors up to their sign).
double path_length(const Eigen::MatrixXd& scores);

/// log(exp(a) + exp(b)).
double log_sum(double a, double b);

}  // namespace imunoise
