#pragma once

#include <span>
#include <vector>

#include "core/array/latents.h"
#include "core/wavelet/wavelet_covariance.h"

namespace imunoise {

/// Where to start the search for an array's shapes: each sensor fitted by itself, as if it shared
/// nothing; shared processes start at the mean of theirs. Where a sensor has several processes of a
/// kind that are shared differently, one start for each way to tell which is which. Only shapes are
/// set.
std::vector<ArrayModel> array_starts(const Model& written, const ArrayModel& open,
                                     std::span<const WaveletCovariance> replicates);

}  // namespace imunoise
