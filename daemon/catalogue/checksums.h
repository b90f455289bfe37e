#pragma once

// A checksum of all that a catalogue in a file says of a recording, in all tables together: it
// shows a changed value, and a row that is missing or one too many.

#include <string>
#include <utility>
#include <vector>

#include "daemon/catalogue/database.h"

namespace imunoise::catalogue {

using EntryKey = std::pair<std::string, std::string>;  ///< bench and folder

/// Notes the checksum of what the database says of a recording, once all of it is written. Nothing
/// to do where the database is no file.
Result<void> seal_entry(Database& database, const std::string& bench, const std::string& folder);

/// Recordings whose rows are not those that were written, or not all of them.
Result<std::vector<EntryKey>> damaged_entries(Database& database);

}  // namespace imunoise::catalogue
