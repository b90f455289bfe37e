#pragma once

#include "core/diagnosis/candidates.h"
#include "core/diagnosis/heldout.h"
#include "core/diagnosis/misfit.h"

namespace imunoise {

enum class DiagnosisVerdict {
  kFound,    ///< one effect, told apart from all others
  kOneOf,    ///< an effect is there; these data cannot tell which
  kUnknown,  ///< the model misses something that no effect of the catalogue explains
  kNone,     ///< nothing is missing that these data could show
};

/// A tried effect with what it does on data that it was not fitted to.
struct RankedEffect {
  TriedEffect tried;
  double familywise_p = 1.0;
  std::optional<Errors> heldout;           ///< absent where nothing can be held out
  std::vector<std::string> confused_with;  ///< ids of effects that these data cannot exclude
};

/// What the smallest effect is that would have been seen nine times in ten.
struct DetectionLimit {
  std::string effect;
  AddedTerm added;  ///< where the search came nearest to seeing one
  std::string parameter;
  double value = 0.0;
};

/// What one look at a model shows.
struct Diagnosis {
  DiagnosisVerdict verdict = DiagnosisVerdict::kNone;
  bool worth_adding = false;  ///< the best effect is no chance, and helps on replicates not used
  std::vector<RankedEffect> effects;  ///< best first
  MisfitReport misfit;                ///< of the model as it is
  double misfit_p = 1.0;
  std::optional<Errors> heldout;  ///< of the model as it is
  std::vector<DetectionLimit> limits;
};

struct DiagnosisOptions {
  double level = 0.05;  ///< chance of a false alarm over everything that is tried
};

/// Tries every effect of the catalogue on a model and says which is missing. Deterministic.
Diagnosis diagnose(const Trial& model, const DiagnosisOptions& options = {},
                   const Progress& progress = {});

/// Fits a model to a subject: what diagnose() starts from. `start`: every value of the noise set.
Trial fit_full_model(std::shared_ptr<const Subject> subject, const FullModel& start,
                     const Progress& progress = {});

}  // namespace imunoise
