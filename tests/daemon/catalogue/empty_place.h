#pragma once

#include <filesystem>
#include <string>

namespace imunoise::testing {

/// Where the catalogue of one test lies, empty at first.
struct EmptyPlace {
  std::string where;
  std::string trouble;  ///< why there is none
};

/// In a SQLite file in the folder, or in a database of a PostgreSQL of our own: as the program is
/// linked.
EmptyPlace empty_place(const std::filesystem::path& folder);

}  // namespace imunoise::testing
