#pragma once

#include <string>
#include <vector>

#include "tests/layering/include_rules.h"

namespace imunoise::testing {

/// What people read: guides and READMEs whole, and of sources the texts in quotes (not those of
/// tests). Lines stay where they are.
Tree read_prose(const std::string& project_root);

/// The texts in quotes of a C++ source, each on its line; code and comments blanked. Raw strings of
/// several lines are left out.
std::string quoted_only(const std::string& source);

/// "docs/a.md:12: 'whoever': say who does it". Words that hide a standard term or the subject of a
/// sentence.
std::vector<std::string> riddles(const Tree& prose);

/// Guides and READMEs whose first line is no heading: a formatter of code took them for code.
std::vector<std::string> without_heading(const Tree& prose);

}  // namespace imunoise::testing
