#pragma once

// Tables whose rows belong to several sensors in turn, or to sensors of several rates.

#include <cstddef>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "recording/import/table/options.h"
#include "recording/import/table/table.h"

namespace imunoise::recording {

/// Puts the columns with these names first, in this order. Returns how many there are.
std::size_t put_first(const std::vector<std::string>& names, std::vector<Column>& columns);

/// The first `wanted` columns stay; the others are there to judge by. Drops those of the others
/// that miss more than a tenth of their values. If a wanted column misses as many, drops those that
/// do not have their values in its rows.
void drop_sparse(std::size_t wanted, std::vector<Column>& columns);

/// Leaves out columns without a value. Where columns miss more than a tenth of their values: takes
/// those apart that have values in different rows, leaves out rows without any, and joins columns
/// of one rate again (join_streams()). Where a column says which sensor a row is of, each sensor
/// gets columns of its own, as do its names in `wanted`. Every other table is returned as it came.
/// Error: see Clock::read and join_streams.
Result<Table> take_apart(const std::string& file, Table table, const ImportOptions& options,
                         std::vector<std::string>& wanted);

}  // namespace imunoise::recording
