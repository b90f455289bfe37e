#pragma once

#include "drivers/codec/bytes.h"
#include "drivers/codec/refusal.h"
#include "drivers/codec/sample.h"

namespace imunoise::drivers {

/// Appends the receiver's solution (MTData2 item 0x7010, 94 bytes): gnss_latitude, ... Layout:
/// ethzasl_xsens_driver; its position agrees with the filter's in a real capture. A wrong length is
/// refused.
void append_gnss_solution(DecodedSample& sample, Bytes data, Refusals& refused);

/// Appends how many satellites the receiver sees (item 0x7020; 8 bytes and 4 for each).
void append_gnss_satellites(DecodedSample& sample, Bytes data, Refusals& refused);

}  // namespace imunoise::drivers
