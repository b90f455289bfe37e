#pragma once

#include "daemon/service/api/methods.h"
#include "daemon/service/recordings/records.h"

namespace imunoise::service {

/// Recordings, calibrations, arrays and histories.
void add_record_methods(Methods& methods, Records& records);

}  // namespace imunoise::service
