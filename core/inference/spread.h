#pragma once

#include <span>
#include <vector>

#include "core/inference/fit.h"

namespace imunoise {

/// How one parameter varies between replicates: a random effect on the scale on which its estimate
/// is normal (ParameterScale), told in the parameter's own unit at its mean.
struct ParameterSpread {
  std::size_t term = 0;
  std::size_t parameter = 0;
  int replicates = 0;   ///< in which it is seen
  double mean = 0.0;    ///< of the distribution that replicates are drawn from
  double spread = 0.0;  ///< its standard deviation, beyond what estimation adds
  double lower = 0.0;   ///< 95 % interval of the spread
  double upper = 0.0;
  /// The same on its scale, where 0.1 means 10 %: of a power or a time, or of the distance of
  /// anything else from its nearer bound.
  double relative = 0.0;
  double relative_lower = 0.0;
  double relative_upper = 0.0;
  double p_value = 1.0;  ///< that it does not move, corrected for the number of parameters (Holm)
  bool moves() const { return p_value < 0.05; }
};

/// From separate estimates of the same terms, one a replicate. Cochran's Q tests each parameter;
/// the spread is Paule & Mandel's (1982), its interval the Q-profile (Viechtbauer 2007). Parameters
/// seen in fewer than three replicates are left out.
std::vector<ParameterSpread> parameter_spread(std::span<const Estimate> separate,
                                              std::span<const WaveletVariance> replicates);

}  // namespace imunoise
