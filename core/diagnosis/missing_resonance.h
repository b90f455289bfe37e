#pragma once

#include "core/diagnosis/score_space.h"

namespace imunoise {

/// A resonance of any frequency, damped or spread (Voigt). One suggestion; none where replicates
/// are too short.
Suggestions search_resonances(const Current& current, const ScoreSpace& space);

/// As fit_full_model(), but resonances whose shape is not given are also sought one after the
/// other: the moments that a fit begins with hardly show a narrow peak, and a fit that begins
/// beside it misses it. The likelier of the two.
FittedModel fit_with_resonances(const std::shared_ptr<const Subject>& subject,
                                const FullModel& start, const Progress& progress = {});

}  // namespace imunoise
