#pragma once

#include "drivers/host/load.h"
#include "imunoise/v1/drivers.pb.h"

namespace imunoise::service {

/// The drivers that were found, as a message.
v1::DriversReport driver_report(const drivers::Drivers& drivers);

}  // namespace imunoise::service
