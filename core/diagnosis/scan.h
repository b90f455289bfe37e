#pragma once

#include <optional>
#include <variant>

#include "core/diagnosis/evidence.h"
#include "core/diagnosis/joint_fit.h"

namespace imunoise {

/// Noise that may be missing.
struct NoiseChange {
  Model start;    ///< the whole noise with it, every value set
  Process added;  ///< it alone
};

/// A term of a model: of its noise, or beside it.
using AddedTerm = std::variant<EffectTerm, NoiseChange>;

/// What may be missing, as a search found it: a term that could be added, at the place where it
/// explains most. To first order only; the joint fit with it is what counts.
struct Suggestion {
  std::string_view effect;  ///< its id in the catalogue
  AddedTerm added;
  double score_nats = 0.0;  ///< log-likelihood that it would gain, to first order
  double dof = 1.0;         ///< coefficients, or powers, that it adds
  bool power = false;       ///< it is a power: one-sided
  Search search{};
  /// 1/variance of its coefficient or power under the current noise; 0 where that has no meaning.
  double information = 0.0;
  /// Standard error of its frequency, Hz, or of the logarithm of its time constant; 0 where none.
  double shape_error = 0.0;
  bool backwards = false;  ///< a witness that explains more when it comes after its effect
};

/// The current model, fitted, and what all searches look at.
struct Current {
  const Regression& regression;
  const JointFit& fit;
  std::vector<BandedPower> pooled;        ///< what the fit leaves, see pooled()
  std::vector<SharedVector> cosines;      ///< what it leaves of each replicate
  std::vector<Eigen::ArrayXd> spectrum;   ///< of the noise at these
  std::vector<Eigen::VectorXd> weighted;  ///< the inverse transform of cosines/spectrum: in time

  const Subject& subject() const { return regression.subject(); }
};
Current current_of(const Regression& regression, const JointFit& fit);

/// Each search suggests at most a few terms, the best of a kind.
using Suggestions = std::vector<Suggestion>;

/// More noise: white, quantisation, flicker, a walk, a Markov process or a resonance anywhere, and
/// white noise through averaging filters.
Suggestions scan_noise(const Current& current);
/// Sine waves of any frequency, their multiples, and the folded mains.
Suggestions scan_lines(const Current& current);
/// A step at any time of any replicate, and jumps between two levels.
Suggestions scan_steps(const Current& current);
/// Ramps and warm-ups.
Suggestions scan_trends(const Current& current);
/// Each witness: static, behind a lag, squared, or in part of the frequencies; and noise that
/// follows it.
Suggestions scan_witnesses(const Current& current);
/// Outliers, powers that differ between replicates.
Suggestions scan_samples(const Current& current);

}  // namespace imunoise
