#pragma once

#include <string>

#include "cli/manual/command_text.h"

namespace imunoise::manual {

/// Scripts that complete commands, options, and values: choices, files, folders, and the drivers
/// that `imunoise drivers --names` lists.
std::string bash_completion(const CommandText& program);
std::string zsh_completion(const CommandText& program);

}  // namespace imunoise::manual
