#pragma once

#include "core/support/result.h"
#include "imunoise/v1/datasheet.pb.h"
#include "study/analysis/series.h"
#include "study/deviation/printed.h"

namespace imunoise::study {

/// The model of printed figures, with its Allan deviation from 10 ms to 10⁵ s, at a rate.
v1::DatasheetReport printed_report(const PrintedFigures& printed, Hertz rate);

/// The same beside the Allan deviation of a channel, with each figure's measured value: N and K at
/// the averaging time where the term has its largest share of the printed model, B from the minimum
/// over 0.664. A figure is missed where the interval of the curve lies above the printed model at
/// that time, met otherwise; K is not seen where its share stays below a half, or where the curve
/// does not surely rise after its minimum. Error: as deviations().
Result<v1::DatasheetReport> compare_with_datasheet(const Series& series,
                                                   const PrintedFigures& printed,
                                                   double confidence);

}  // namespace imunoise::study
