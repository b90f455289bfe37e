#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <vector>

#include "cli/arguments.h"

namespace imunoise::cli {

/// One command: its options, and a function that turns them into arguments after parsing.
struct ParsedCommand {
  CLI::App* app;
  std::function<Arguments::Command()> arguments;  ///< may throw CLI::ValidationError
};

// Each adds some commands to the program.
std::vector<ParsedCommand> analysis_commands(
    CLI::App& program);                                        ///< wv, fit, test, select, dynamic
std::vector<ParsedCommand> array_commands(CLI::App& program);  ///< array, mixed, faults
std::vector<ParsedCommand> diagnosis_commands(CLI::App& program);  ///< diagnose, study
std::vector<ParsedCommand> open_commands(CLI::App& program);       ///< open
std::vector<ParsedCommand> export_commands(CLI::App& program);     ///< export
std::vector<ParsedCommand> datasheet_commands(CLI::App& program);  ///< datasheet
std::vector<ParsedCommand> recording_commands(CLI::App& program);  ///< simulate, record, verify
std::vector<ParsedCommand> device_commands(CLI::App& program);     ///< drivers, decode
std::vector<ParsedCommand> emulation_commands(CLI::App& program);  ///< emulate
std::vector<ParsedCommand> replay_commands(CLI::App& program);     ///< replay
std::vector<ParsedCommand> batch_commands(CLI::App& program);      ///< batch
std::vector<ParsedCommand> catalogue_commands(
    CLI::App& program);  ///< calibrate, recordings, calibrations, history
std::vector<ParsedCommand> daemon_commands(
    CLI::App& program);  ///< devices, campaigns, status, live, start, stop

}  // namespace imunoise::cli
