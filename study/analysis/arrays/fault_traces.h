#pragma once

#include <cstddef>
#include <vector>

#include "imunoise/v1/faults.pb.h"
#include "study/analysis/series.h"

namespace imunoise::study {

/// Writes how far each sensor is from the mean of the others in one replicate, in up to 240 parts.
void add_traces(const std::vector<Series>& sensors, std::size_t replicate, v1::FaultReport& out);

/// The least difference that is not zero between two readings of a sensor in a row; 0 when none
/// differ.
double resolution_of(const Series& sensor);

}  // namespace imunoise::study
