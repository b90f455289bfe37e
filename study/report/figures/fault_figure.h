#pragma once

#include <optional>
#include <string>

#include "imunoise/v1/faults.pb.h"
#include "study/figure/figure.h"

namespace imunoise::report {

/// Each sensor of a replicate against the mean of the others, a row a sensor, with the places where
/// its faults began. Nothing without traces.
std::optional<figure::Figure> fault_figure(const v1::FaultReport& report,
                                           const std::string& replicate);

}  // namespace imunoise::report
