#pragma once

#include "imunoise/v1/datasheet.pb.h"
#include "study/figure/figure.h"

namespace imunoise::report {

/// The Allan deviation of the printed figures as a line, over the measured one with its intervals.
figure::Figure datasheet_figure(const v1::DatasheetReport& report);

}  // namespace imunoise::report
