#pragma once

#include <vector>

#include "core/effect/effect.h"
#include "core/effect/reported_number.h"

namespace imunoise {

/// How noise that each replicate has of its own differs from that of all, with 95 % intervals by
/// Whittle's information: the spread of what differs most; the ratio of each replicate's power, or
/// of each process in it where one ratio does not tell all; with `shapes` the shapes of each.
std::vector<ReportedNumber> own_ratios(const FittedEffect& effect, bool shapes);

}  // namespace imunoise
