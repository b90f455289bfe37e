#pragma once

#include "imunoise/v1/batch.pb.h"
#include "study/report/documents/document.h"
#include "study/words/number.h"

namespace imunoise::report {

/// What `imunoise batch` says, for page and terminal.
Document document(const v1::BatchStatus& status, Digits digits);
Document document(const v1::BatchReport& report, Digits digits);

}  // namespace imunoise::report
