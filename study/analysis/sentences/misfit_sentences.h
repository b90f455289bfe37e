#pragma once

// Where a model fails: a sentence a place, merged over time and replicates.

#include "core/diagnosis/views/misfit.h"
#include "imunoise/v1/diagnosis.pb.h"

namespace imunoise::study {

/// Adds the worst misfits, at most twelve, worst first, of a report whose `before` and
/// `compared_before` are set. `misfit` is that of the same model.
void add_misfits(const MisfitReport& misfit, v1::DiagnosisReport& to);

}  // namespace imunoise::study
