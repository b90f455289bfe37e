#pragma once

#include "core/regression/current.h"
#include "core/search/suggestion.h"

namespace imunoise {

/// White noise through the device's filter instead of white noise: the best running mean, the best
/// of two in cascade, and one whose window is no multiple of the sampling interval. None where the
/// model has no white noise of free power.
Suggestions search_filters(const Current& current);

}  // namespace imunoise
