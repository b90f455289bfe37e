#pragma once

#include "imunoise/v1/calibration.pb.h"
#include "imunoise/v1/catalogue.pb.h"
#include "study/report/documents/document.h"
#include "study/words/number.h"

namespace imunoise::report {

/// What the commands of calibration and catalogue say, for page and terminal.
Document document(const v1::Calibration& calibration, Digits digits);
Document document(const v1::RecordingList& list, Digits digits);
Document document(const v1::CalibrationList& list, Digits digits);
Document document(const v1::History& history, Digits digits);

}  // namespace imunoise::report
