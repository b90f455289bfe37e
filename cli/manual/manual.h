#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "cli/manual/man_page.h"

namespace imunoise::manual {

/// Makes --help print help_text(), and adds the hidden option --write-manual FOLDER: it writes the
/// manual pages and completions of the program into FOLDER, laid out as below /usr/share. Call it
/// before commands are added, which inherit the help. `files` describes the files that it reads.
void add_manual(CLI::App& program, int section, const std::string& version,
                const std::function<std::vector<FileText>()>& files = {});

}  // namespace imunoise::manual
