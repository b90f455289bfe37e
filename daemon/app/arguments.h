#pragma once

#include <filesystem>
#include <variant>
#include <vector>

namespace imunoise::app {

struct Arguments {
  std::vector<std::filesystem::path> campaigns;  ///< Files, and folders of files.
  std::vector<std::filesystem::path> driver_folders;
  bool check_config = false;
  bool print_timer = false;
  bool once = false;
};

/// What was asked for, or the exit status where that is all: help, version, wrong usage (2).
std::variant<Arguments, int> parse_arguments(int argc, const char* const* argv);

}  // namespace imunoise::app
