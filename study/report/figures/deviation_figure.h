#pragma once

#include "imunoise/v1/deviation.pb.h"
#include "study/figure/figure.h"

namespace imunoise::report {

/// Deviation over averaging time with intervals, both axes logarithmic, in the unit of data sheets.
figure::Figure deviation_figure(const v1::DeviationReport& report);

}  // namespace imunoise::report
