#pragma once

// Where a sensor hangs: its samples stay what they were.

#include <vector>

#include "core/support/units.h"
#include "recording/import/preflight/cuts.h"
#include "recording/import/table/table.h"

namespace imunoise::recording {

/// Rows that repeat the row before on every axis of motion, for longer than chance repeats them
/// once in a million recordings: 64 rows at least. None where hardly any other row is left. What a
/// channel measures is known by its unit, else by its name.
std::vector<Cut> frozen_in(const std::vector<Column>& columns, const std::vector<Unit>& units);

}  // namespace imunoise::recording
