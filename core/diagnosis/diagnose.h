#pragma once

#include "core/diagnosis/proof.h"
#include "core/diagnosis/views/misfit.h"

namespace imunoise {

enum class DiagnosisVerdict {
  kFound,    ///< one effect, told apart from all others
  kOneOf,    ///< an effect is there; these data cannot tell which
  kUnknown,  ///< the model misses something that no effect of the catalogue explains
  kNone,     ///< nothing is missing that these data could show
};

/// What the smallest effect is that would have been seen nine times in ten.
struct DetectionLimit {
  std::string cause;
  AddedTerm added;        ///< where the search came nearest to seeing one
  std::string parameter;  ///< the power of noise, "sigma2", or the effect's coefficient
  double value = 0.0;
};

/// What one look at a model shows.
struct Diagnosis {
  DiagnosisVerdict verdict = DiagnosisVerdict::kNone;
  double searches = 0.0;      ///< that were made
  bool worth_adding = false;  ///< the best effect is no chance, and helps on replicates not used
  std::vector<RankedTerm> effects;  ///< best first
  MisfitReport misfit;              ///< of the model as it is
  double misfit_p = 1.0;
  std::optional<HeldOut> heldout;  ///< of the model as it is
  std::vector<DetectionLimit> limits;
};

/// Tries every effect of the catalogue on a model and says which is missing. `level`: false-alarm
/// probability over everything that is tried. Deterministic.
Diagnosis diagnose(const FittedModel& model, double level = 0.05, const Progress& progress = {});

}  // namespace imunoise
