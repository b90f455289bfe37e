#pragma once

// A catalogue in a file is checked before it is believed: the disk, or a copy that broke off, may
// have changed any byte of it, and SQLite reads on where the bytes still make sense. What is
// damaged is forgotten, since the recordings say it again. PostgreSQL is trusted.

#include <memory>
#include <string>
#include <string_view>

#include "daemon/catalogue/database.h"

namespace imunoise::catalogue {

/// How a catalogue is called in the folder of its recordings.
inline constexpr std::string_view kCatalogueName = "catalogue.sqlite";

struct SoundDatabase {
  std::unique_ptr<Database> database;  ///< with its tables
  std::string repair;                  ///< what was damaged and what became of it; else empty
};

/// Opens the catalogue in `where`. Entries whose checksums do not fit are removed from it; a file
/// whose structure is damaged is renamed to NAME.damaged and replaced by an empty one. Error: the
/// database's, or a file that is no database and is not called as a catalogue is.
Result<SoundDatabase> open_sound(const std::string& where);

}  // namespace imunoise::catalogue
