#pragma once

#include "core/diagnosis/candidates.h"
#include "core/diagnosis/heldout.h"
#include "core/diagnosis/views/misfit.h"

namespace imunoise {

enum class DiagnosisVerdict {
  kFound,    ///< one effect, told apart from all others
  kOneOf,    ///< an effect is there; these data cannot tell which
  kUnknown,  ///< the model misses something that no effect of the catalogue explains
  kNone,     ///< nothing is missing that these data could show
};

/// A tried term with what it does on data that it was not fitted to.
struct RankedTerm {
  TriedTerm tried;
  double familywise_p = 1.0;
  std::optional<HeldOut> heldout;          ///< absent where nothing can be held out
  std::vector<std::string> confused_with;  ///< ids of effects that these data cannot exclude
};

/// What the smallest effect is that would have been seen nine times in ten.
struct DetectionLimit {
  std::string cause;
  AddedTerm added;        ///< where the search came nearest to seeing one
  std::string parameter;  ///< "power", or the effect's coefficient
  double value = 0.0;
};

/// What one look at a model shows.
struct Diagnosis {
  DiagnosisVerdict verdict = DiagnosisVerdict::kNone;
  bool worth_adding = false;  ///< the best effect is no chance, and helps on replicates not used
  std::vector<RankedTerm> effects;  ///< best first
  MisfitReport misfit;              ///< of the model as it is
  double misfit_p = 1.0;
  std::optional<HeldOut> heldout;  ///< of the model as it is
  std::vector<DetectionLimit> limits;
};

struct DiagnosisOptions {
  double level = 0.05;  ///< false-alarm probability over everything that is tried
  /// Only the next term of a ladder is wanted: it is sought in the beginnings of the replicates,
  /// and the first that proves itself on the whole will do. Where nothing does, everything is tried
  /// on the whole.
  bool climbing = false;
};

/// Tries every effect of the catalogue on a model and says which is missing. Deterministic.
Diagnosis diagnose(const FittedModel& model, const DiagnosisOptions& options = {},
                   const Progress& progress = {});

}  // namespace imunoise
