#pragma once

// Steps that people count in: of numbers, of a clock, of a calendar.

#include <vector>

#include "study/figure/scale.h"

namespace imunoise::figure {

/// The least step of at least `least`: 1, 2 or 5 times a power of ten.
double round_step(double least);

/// The same in seconds of a clock: round minutes, hours and days.
double clock_step(double least);

/// Ticks between two times in seconds since 1970-01-01 UTC, at least `least` seconds apart:
/// moments, days, or beginnings of months and years, with labels that say as much. Of moments the
/// first, and the first of another day, say the day.
std::vector<Tick> time_ticks(double low, double high, double least);

}  // namespace imunoise::figure
