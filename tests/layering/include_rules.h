#pragma once

// The layering of the house as a table, and the reading of include lines that holds the sources to
// it.

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace imunoise::testing {

/// Sources by their path from the project's root: "core/support/result.h" → its text.
using Tree = std::map<std::string, std::string>;

/// Every C++ source and header under the folders that hold code.
Tree read_tree(const std::string& project_root);

/// The room a path belongs to, as in the table: "core/wavelet", "study", ...; "" when it has none.
/// Generated headers of proto/ count as "proto".
std::string room_of(std::string_view path);

/// What breaks the layering, one readable line each, naming file, line and what would be right.
std::vector<std::string> layering_violations(const Tree& tree);

/// Headers that lack #pragma once.
std::vector<std::string> unguarded_headers(const Tree& tree);

/// Files of the program that are longer than the house allows, "path: lines".
std::vector<std::string> long_files(const Tree& tree);

}  // namespace imunoise::testing
