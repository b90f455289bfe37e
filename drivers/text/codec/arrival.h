#pragma once

// When rows were sampled, from when they came.

#include <cstdint>
#include <vector>

#include "drivers/text/codec/row.h"

namespace imunoise::text {

struct ArrivedRow {
  TextRow row;
  std::int64_t host_time_ns = 0;  ///< when it came
};

/// Of rows that came at once only the last came when it was sampled: the others get times as much
/// earlier as the device's clock says or, without one, at its rate. `period_ns`: of a row.
void spread_in_time(std::vector<ArrivedRow>& rows, double period_ns);

}  // namespace imunoise::text
