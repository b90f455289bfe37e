#pragma once

#include <optional>

#include "imunoise/v1/fleet.pb.h"
#include "study/figure/figure.h"

namespace imunoise::report {

/// One parameter of all devices of a type: a row a device with its interval, over the quartiles and
/// the median of all; orange: an outlier. Nothing without devices.
std::optional<figure::Figure> fleet_figure(const v1::FleetParameter& parameter);

}  // namespace imunoise::report
