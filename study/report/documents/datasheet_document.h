#pragma once

#include "imunoise/v1/datasheet.pb.h"
#include "study/report/documents/document.h"
#include "study/words/number.h"

namespace imunoise::report {

/// Printed figures beside what was measured.
Document document(const v1::DatasheetReports& reports, Digits digits);

}  // namespace imunoise::report
