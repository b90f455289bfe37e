#pragma once

// Samples that are not what the sensor measured: repeated, interpolated, filtered.

#include <vector>

#include "core/support/units.h"
#include "recording/import/table/table.h"

namespace imunoise::recording {

/// Doubts about the axes of each sensor (angular rates, accelerations), from at most 2^18 rows of
/// [begin, begin + count), which miss no value. What a channel measures is known by its unit, else
/// by its name:
/// - rows that repeat the row before on all axes, five times as often as rows 16 apart agree;
/// - rows on a straight line with their two neighbours on all axes (second difference below 10⁻³ of
///   its rms), five times as often as coarse numbers would by chance;
/// - an axis that never changes;
/// - a power spectral density (Hann, segments of 64) that is flat at low frequencies and lower by
///   10 dB in the highest fifth of its range, on all axes.
/// Only of sensors that have an axis among the first `wanted` columns.
void find_suspects(const std::vector<Column>& columns, const std::vector<Unit>& units,
                   std::size_t wanted, Hertz rate, std::size_t begin, std::size_t count,
                   std::vector<Finding>& findings);

}  // namespace imunoise::recording
