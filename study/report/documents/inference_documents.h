#pragma once

#include "imunoise/v1/array.pb.h"
#include "imunoise/v1/diagnosis.pb.h"
#include "imunoise/v1/dynamic.pb.h"
#include "imunoise/v1/faults.pb.h"
#include "imunoise/v1/inference.pb.h"
#include "imunoise/v1/mixed.pb.h"
#include "imunoise/v1/study.pb.h"
#include "study/report/documents/document.h"
#include "study/words/number.h"

namespace imunoise::report {

/// What the commands of analysis say, for page and terminal.
Document document(const v1::StationarityReports& reports, Digits digits);
Document document(const v1::ChoiceReports& reports, Digits digits);
Document document(const v1::ArrayReport& report, Digits digits);
Document document(const v1::MixedReport& report, Digits digits);
Document document(const v1::FaultReport& report, Digits digits);
Document document(const v1::DynamicReports& reports, Digits digits);
Document document(const v1::DiagnosisReports& reports, Digits digits);
Document document(const v1::Study& study, Digits digits);

}  // namespace imunoise::report
