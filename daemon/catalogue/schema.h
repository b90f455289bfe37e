#pragma once

#include "daemon/catalogue/database.h"

namespace imunoise::catalogue {

/// Counts up when a table changes: the catalogue is then made anew from the recordings.
inline constexpr std::int64_t kSchemaVersion = 2;

/// Makes the tables of a new database, and empties one of an older version. Error: the database's,
/// or one of a later version.
Result<void> prepare_schema(Database& database);

}  // namespace imunoise::catalogue
