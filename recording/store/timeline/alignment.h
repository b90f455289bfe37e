#pragma once

// A slower or later stream as another stream's samples see it.

#include <cstdint>
#include <span>
#include <vector>

#include "recording/store/stream/stream.h"

namespace imunoise::recording {

/// The numbers of a channel at other times (ns, rising): on the straight line between the rows
/// before and after, and as the first or last row where there is none. Zeros where the channel has
/// no rows. `times` are those of its rows, one a number.
std::vector<double> at_times(const Numbers& numbers, std::span<const std::int64_t> times,
                             std::span<const std::int64_t> wanted);

}  // namespace imunoise::recording
