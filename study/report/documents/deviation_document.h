#pragma once

#include "imunoise/v1/deviation.pb.h"
#include "study/report/documents/document.h"
#include "study/words/number.h"

namespace imunoise::report {

/// Allan or Hadamard deviations as figures and tables.
Document document(const v1::DeviationReports& reports, Digits digits);

}  // namespace imunoise::report
