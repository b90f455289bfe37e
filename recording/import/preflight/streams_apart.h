#pragma once

// Tables whose rows belong to several sensors in turn, or to sensors of several rates.

#include <string>

#include "core/support/result.h"
#include "recording/import/table/options.h"
#include "recording/import/table/table.h"

namespace imunoise::recording {

/// Leaves out columns without a value. Where columns miss more than a tenth of their values: takes
/// those apart that have values in different rows, leaves out rows without any, and joins columns
/// of one rate again (join_streams()). Every other table is returned as it came. Error: see
/// Clock::read and join_streams.
Result<Table> take_apart(const std::string& file, Table table, const ImportOptions& options);

}  // namespace imunoise::recording
