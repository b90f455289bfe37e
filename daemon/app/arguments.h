#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace imunoise::app {

struct Arguments {
  std::vector<std::filesystem::path> campaigns;  ///< Files, and folders of files.
  std::vector<std::filesystem::path> driver_folders;
  bool check_config = false;
  bool print_timer = false;
  bool once = false;
  std::optional<std::filesystem::path> socket;  ///< Of the API.
  std::optional<std::string> listen;            ///< Its address on loopback.
  std::optional<std::filesystem::path> tokens;  ///< Of those who come that way.
  std::vector<std::string> hosts;               ///< Names of this machine beside localhost.
  std::filesystem::path studies;                ///< Folder of the API's studies.
};

/// What was asked for, or the exit status where that is all: help, version, wrong usage (2).
std::variant<Arguments, int> parse_arguments(int argc, const char* const* argv);

}  // namespace imunoise::app
