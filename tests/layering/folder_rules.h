#pragma once

// The size of folders, their maps, and what documents say of them.

#include <set>
#include <string>
#include <vector>

#include "tests/layering/include_rules.h"

namespace imunoise::testing {

/// Folders with more than 25 sources, with their number; name.h and name.cpp count as one.
std::vector<std::string> crowded_folders(const Tree& tree);

/// Paths of the README.md of every folder, from the project's root.
std::set<std::string> read_maps(const std::string& project_root);

/// Folders of sources without a README.md. A folder tests/X whose X is a folder of the house needs
/// none: what X holds is what it tests.
std::vector<std::string> folders_without_map(const Tree& tree, const std::set<std::string>& maps);

/// A text file as it is; empty where there is none.
std::string read_text(const std::string& path);

/// Paths between backquotes in `text`, from the project's root, that are not there. Paths with a
/// name in capitals or a star stand for many.
std::vector<std::string> missing_places(const std::string& text, const std::string& project_root);

}  // namespace imunoise::testing
