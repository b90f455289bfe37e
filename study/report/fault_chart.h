#pragma once

#include <optional>
#include <string>

#include "imunoise/v1/faults.pb.h"
#include "study/report/documents/document.h"

namespace imunoise::report {

/// How far each sensor of one replicate is from the mean of the others, a row a sensor, with its
/// faults marked; nothing where the report has no traces of it. For page figures: both widths.
std::optional<Figure> fault_chart(const v1::FaultReport& report, const std::string& replicate);

}  // namespace imunoise::report
