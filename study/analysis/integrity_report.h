#pragma once

// What is wrong with samples, or told by their clocks, as findings of a diagnosis.

#include <vector>

#include "imunoise/v1/diagnosis.pb.h"
#include "recording/import/table/channel.h"
#include "study/analysis/series.h"

namespace imunoise::study {

/// Defects that the values show, see integrity().
void add_integrity(const Series& series, v1::DiagnosisReport& to);

/// Defects of the samples look like anything: they are the verdict, and what else seems missing
/// comes after them. `mended`: that was sought in samples that were cut or replaced.
void put_defects_first(bool mended, v1::DiagnosisReport& to);

/// What counters and clocks showed. Nothing is wrong with the samples themselves.
void add_timing(const std::vector<recording::Replicate>& recordings, v1::DiagnosisReport& to);

}  // namespace imunoise::study
