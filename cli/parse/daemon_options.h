#pragma once

#include <string>

#include "cli/parse/commands.h"

namespace imunoise::cli {

/// Where the daemon answers, as it was typed.
struct RawDaemon {
  std::string socket;
  std::string url;
  std::string token_file;
};

/// Adds --socket, --url and --token-file.
void add_daemon(CLI::App& command, RawDaemon& raw);
DaemonArguments daemon_from(const RawDaemon& raw);

}  // namespace imunoise::cli
