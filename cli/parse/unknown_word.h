#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace imunoise::cli {

/// What is printed when the command line cannot be parsed: CLI11's sentence, or, of a command or an
/// option that there is not, its name and the nearest known one; so of a value that is none of the
/// choices.
std::string usage_error(const CLI::App* program, const CLI::Error& error);

}  // namespace imunoise::cli
