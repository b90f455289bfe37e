#pragma once

#include <string>

#include "cli/manual/command_text.h"

namespace imunoise::manual {

/// What --help prints: purpose, usage, examples, then arguments, options and commands in lines of
/// at most 100 characters, then notes.
std::string help_text(const CommandText& command);

}  // namespace imunoise::manual
