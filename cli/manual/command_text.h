#pragma once

// What the command line says about itself, read from CLI11's own tree: help, manual pages and
// completion are three prints of it.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace imunoise::manual {

/// What can stand in the place of a value.
enum class Values { kNone, kChoices, kFile, kFolder, kDriver, kOther };

/// One option, or one argument by its place.
struct OptionText {
  std::vector<std::string> names;  ///< "-h", "--help"; of an argument "FILES"
  std::string value;               ///< "HZ", "full|diag"; empty: a flag
  std::string about;               ///< with range and default in brackets
  Values values = Values::kNone;
  std::vector<std::string> choices;
  bool required = false;
  bool several = false;
};

struct CommandText {
  std::string name;                   ///< "imunoise batch new"
  std::string about;                  ///< one line
  std::string examples;               ///< lines; may be empty
  std::string notes;                  ///< paragraphs; lines that begin with a blank stay
  std::vector<OptionText> arguments;  ///< in their order
  std::vector<OptionText> options;    ///< with those of the program that hold here too
  std::string group;                  ///< title of the group that it stands in; empty: the program
  std::vector<std::string> groups;    ///< titles of the groups of `parts`, in their order
  std::vector<CommandText> parts;     ///< subcommands
};

/// Reads one command with everything below it. The footer of a command begins with "Examples:";
/// what follows its first blank line are notes.
CommandText read_command(const CLI::App& command);

/// "[OPTIONS] FILES...", behind the name.
std::string usage(const CommandText& command);

/// The last word of its name.
std::string short_name(const CommandText& command);

}  // namespace imunoise::manual
