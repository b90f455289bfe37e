#pragma once

// Reads what a plugin describes. Nothing of it is believed before it is looked at.

#include <string>

#include "core/support/result.h"
#include "drivers/description.h"

namespace imunoise::drivers {

/// The driver that a table describes. Error, naming the part ("stream imu: channel 2: ..."):
/// another ABI, a table or a part that is too small, a missing operation, a missing or ill-formed
/// name, two of one name, a number that is not finite or has no meaning, an unknown type, a default
/// that the option itself does not allow. The table's size and ABI are looked at first.
Result<DriverInfo> check_driver(const imunoise_driver* table);

/// What an open device is. Errors: as for a driver; no stream.
Result<DeviceInfo> check_device(const imunoise_device_info* table);

}  // namespace imunoise::drivers
