#pragma once

#include "daemon/catalogue/database.h"
#include "daemon/catalogue/scan.h"

namespace imunoise::catalogue {

/// Forgets a recording and what was said of it.
Result<void> remove_entry(Database& database, const std::string& bench, const std::string& folder);

/// Writes down what the files of a recording say, in place of what was known of it. In a
/// transaction of the caller.
Result<void> put_entry(Database& database, const std::string& bench, const Found& found);

}  // namespace imunoise::catalogue
