#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cli/arguments.h"

namespace imunoise::cli {

/// The options of a recording as they were typed; texts need a look-up after parsing.
struct RawInput {
  std::vector<std::string> files;
  std::vector<std::string> channels;
  double rate = 0.0;
  std::string unit;
  std::string time_unit;
  std::optional<double> from;
  std::optional<double> until;
  std::vector<std::string> exclude;
  bool strict = false;
  std::string topic;
  std::string dbc;
  std::string delimiter;
  bool header = false;
  bool no_header = false;
  std::size_t split_into = 1;
  int per_octave = 1;
  std::string robust;
};

// Checks of a number's sign. CLI11's own print the largest double in their message.
CLI::Validator above_zero();
CLI::Validator zero_or_above();

/// Adds FILES and the options that say how to read them.
void add_input(CLI::App& command, RawInput& raw);
/// Says that the command takes just these channels where none is named.
void by_default_of_inertia(CLI::App& command);
/// Adds the number of scales of the wavelet variance.
void add_scales(CLI::App& command, RawInput& raw);
/// Adds all options of the wavelet variance.
void add_measure(CLI::App& command, RawInput& raw);

// What was typed, looked up. They throw CLI::ValidationError.
InputArguments input_from(const RawInput& raw);
/// As a study keeps it: absolute paths, whatever folder is the current one later.
v1::StudyInput study_input_from(const RawInput& raw);
/// What study_input_from() was made of.
RawInput raw_from(const v1::StudyInput& input);
study::MeasureOptions measure_from(const RawInput& raw);
Unit unit_from(const std::string& text);
[[noreturn]] void refuse(const std::string& option, const std::string& why);

}  // namespace imunoise::cli
