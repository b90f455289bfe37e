#pragma once

#include "imunoise/v1/diagnosis.pb.h"
#include "study/report/documents/document.h"

namespace imunoise::report {

struct VerdictWords {
  const char* badge;  ///< "effect found", "nothing missing", ...
  Mood mood;
};

VerdictWords diagnosis_words(const v1::DiagnosisReport& report);

/// Whether noise alone makes a search look as good less often than once in twenty. Other candidates
/// are not listed.
inline bool beyond_chance(const v1::EffectCandidate& one) { return one.familywise_p() < 0.05; }

}  // namespace imunoise::report
