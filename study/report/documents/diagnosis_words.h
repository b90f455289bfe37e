#pragma once

#include "imunoise/v1/diagnosis.pb.h"
#include "study/report/documents/document.h"

namespace imunoise::report {

struct VerdictWords {
  const char* badge;  ///< "effect found", "nothing missing", ...
  Mood mood;
};

VerdictWords diagnosis_words(const v1::DiagnosisReport& report);

}  // namespace imunoise::report
