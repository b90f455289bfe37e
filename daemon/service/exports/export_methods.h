#pragma once

#include "daemon/service/api/methods.h"
#include "daemon/service/recordings/records.h"
#include "daemon/service/studies/study_store.h"

namespace imunoise::service {

/// Calibrations and studies for other programs. All outlive the methods.
void add_export_methods(Methods& methods, const Records& records, const StudyStore& studies);

}  // namespace imunoise::service
