#pragma once

#include <span>
#include <vector>

#include "core/estimate/estimators.h"

namespace imunoise {

/// Which replicates are held out to be predicted by a model fitted to the others.
enum class Splits {
  kLeaveOneOut,  ///< each replicate once
  kHalf,         ///< every choice of ⌊K/2⌋, trained on ⌈K/2⌉: CV-WVIC as published
};

struct ChoiceOptions {
  Splits splits = Splits::kLeaveOneOut;
  /// kFull: distance on the scale on which moments are normal, whitened by the covariance under the
  /// candidate that fits all replicates best. kDiagonal: the published distance.
  Weighting weighting = Weighting::kFull;
};

enum class ChoiceVerdict {
  kSelected,        ///< predicts best
  kEquivalent,      ///< its error is not significantly larger
  kNotAppropriate,  ///< it is
};

/// A number with its 95 % interval.
struct Interval {
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;
};

/// One model and how well it predicts replicates that it was not fitted to.
struct Candidate {
  std::size_t place = 0;  ///< in the list of models
  Model model;            ///< fitted to all replicates
  /// Held-out distance over what the noise of a replicate's moments alone makes: 1.0 is the noise
  /// floor, which only the true parameters reach.
  Interval merit;
  Interval excess;  ///< merit less that of the selected model, replicate by replicate
  ChoiceVerdict verdict = ChoiceVerdict::kNotAppropriate;
};

struct ModelChoice {
  std::vector<Candidate> candidates;  ///< best first
  std::size_t splits = 0;             ///< how many ways the replicates were divided
};

/// Every model that keeps some of the terms, the whole one included: 2*AR1 + WN has 5. Equal terms
/// are not told apart.
std::vector<Model> sub_models(const Model& model);

/// Cross-validated choice among models (CV-WVIC, Radi et al. 2019). Intervals come from the
/// differences between held-out replicates, of which there are K, and not from the splits, which
/// overlap. Preconditions: at least one model; at least two replicates, all of one rate.
ModelChoice choose_model(std::span<const Model> models, std::span<const WaveletVariance> replicates,
                         const ChoiceOptions& options = {}, const Progress& progress = {});
/// The same of models that are fitted already, by mugmwm() with full weights.
ModelChoice choose_model(std::span<const Estimate> fits,
                         std::span<const WaveletVariance> replicates, const ChoiceOptions& options);

}  // namespace imunoise
