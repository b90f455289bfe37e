#pragma once

#include <span>
#include <vector>

#include "core/estimate/fisher_scoring.h"
#include "core/model/model.h"
#include "core/spectrum/banded_power.h"

namespace imunoise {

/// A likelihood that sees the middles of bands cannot tell the power of a peak that lies sharp
/// between two of them. Peaks (RES, VOIGT, AR2 with complex roots) whose decay is free become as
/// wide as half the distance of two middles there.
void widen_peaks(Model& model, std::span<const BandedPower> replicates);

/// Takes away what would make a peak sharper than that. `asked`: the model at the coordinates;
/// `widened`: after widen_peaks(). `to`: by these coordinates.
void hold_at_limit(const Model& asked, const Model& widened,
                   const std::vector<ParameterPlace>& coordinates, Curvature& to);

}  // namespace imunoise
